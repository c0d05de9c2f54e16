#include "pipeline/stages/identify_stage.h"

namespace cgsr::stages {

std::string_view to_string(PersonState state) {
  switch (state) {
    case PersonState::kNobody:
      return "nobody";
    case PersonState::kEnrolled:
      return "enrolled";
    case PersonState::kStranger:
      return "stranger";
    case PersonState::kUnsure:
      return "unsure";
  }
  return "";
}

PersonState IdentifiedPeople::state_of(const person::PeopleInView& people) {
  const std::optional<person::Label>& person = people.person.person;
  if (!person) return people.face_count > 0 ? PersonState::kUnsure : PersonState::kNobody;
  return *person == person::kStranger ? PersonState::kStranger : PersonState::kEnrolled;
}

IdentifiedPeople IdentifyStage::update(WorkBudget& budget, const ImageView& image, const Requests& requests) {
  IdentifiedPeople people{identifier_.identify(image, requests.person, budget)};
  const person::PersonSighting& sighting = people.person;
  const PersonState state = IdentifiedPeople::state_of(people);
  if (sighting.person != last_person_ || state != last_state_) {
    Event event{"person", to_string(state), sighting.person ? to_string(sighting.source) : std::string_view{}};
    if (sighting.person) event.numbers[event.number_count++] = {"number", static_cast<double>(*sighting.person), ""};
    people.events.add(event);
    last_person_ = sighting.person;
    last_state_ = state;
  }
  return people;
}

}  // namespace cgsr::stages
