#include "pipeline/stages/finals_task.h"

namespace cgsr::stages {
namespace {

constexpr int kFacesOfALostOne = 2;  // images with a stranger's face, before the shirt below it counts as well

}  // namespace

std::string_view to_string(FinalsState state) {
  switch (state) {
    case FinalsState::kMeeting:
      return "meeting the person";
    case FinalsState::kWith:
      return "with the person";
    case FinalsState::kSeeking:
      return "looking for the person";
  }
  return "unknown";
}

FinalsTask::FinalsTask(const behavior::FinalsParameters& finals, const behavior::FollowPersonParameters& person,
                       const behavior::FollowParameters& follow, const behavior::DriveLimits& limits,
                       const geometry::Camera& camera, const behavior::FillLightParameters& light)
    : parameters_(finals),
      person_(person.number),
      follow_(person, follow, limits, camera, light),
      shirt_(finals.images_of_shirt) {}

void FinalsTask::say(std::string_view words, Events& events) const {
  Event event{"says", words, to_string(state_)};
  event.numbers[event.number_count++] = {"number", static_cast<double>(person_), ""};
  if (const auto change = shirt_.change(); change && state_ == FinalsState::kWith)
    event.numbers[event.number_count++] = {"shirt", *change, ""};
  events.add(event);
}

// Whoever was named in too few images in a row may have been somebody else: his shirt is not looked at.
void FinalsTask::see_person(const person::PersonSighting& who, const ImageView& image, Events& events) {
  other_images_ = 0;
  if (++person_images_ < parameters_.images_to_be_sure && state_ != FinalsState::kWith) return;
  if (state_ != FinalsState::kWith) {
    const bool again = state_ == FinalsState::kSeeking;
    state_ = FinalsState::kWith;
    shirt_told_ = !again;
    follow_.follow_by_primary_only(false);
    say(again ? "I have found you again" : "I know you, and follow you", events);
  }
  shirt_.see(image, who.box);
  const auto change = shirt_.change();
  if (shirt_told_ || !change) return;
  shirt_told_ = true;
  say(*change > parameters_.max_same_shirt ? "you wear another shirt" : "you wear the same shirt", events);
}

void FinalsTask::see_somebody_else(Events& events) {
  person_images_ = 0;
  if (++other_images_ >= parameters_.images_to_be_sure && state_ == FinalsState::kWith) lose(events);
}

// Who was followed wears the person's shirt, and may turn the back again: until the person's face is seen the shirt proves nothing.
void FinalsTask::lose(Events& events) {
  person_images_ = 0;
  state_ = FinalsState::kSeeking;
  say("you are somebody else: I have lost the person whom I follow", events);
  shirt_.begin_anew();
  follow_.follow_by_primary_only(true);
}

// Images in which no face is looked for, or none is found, say nothing against what was seen before. A stranger's that was decided on twice and is lost then is
// still above the shirt.
Decision FinalsTask::decide(const FrameResult& frame, const ImageView& image, Duration elapsed) {
  Decision decision = follow_.decide(frame, image, elapsed);
  const IdentifiedPeople* const people = frame.people.within(Duration::zero());
  if (people == nullptr) return decision;
  if (follow_.is_with_a_stranger() && state_ == FinalsState::kWith) lose(decision.events);
  const person::PersonSighting& who = people->person;
  const bool is_below_lost_face = who.person == person::kStranger && other_images_ >= kFacesOfALostOne;
  if (who.age_images > 0 || (who.source != person::PersonSource::kFace && !is_below_lost_face)) return decision;
  if (who.person == person_) {
    see_person(who, image, decision.events);
  } else {
    see_somebody_else(decision.events);
  }
  return decision;
}

}  // namespace cgsr::stages
