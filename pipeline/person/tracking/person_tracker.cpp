#include "pipeline/person/tracking/person_tracker.h"

namespace cgsr::person {
namespace {

constexpr std::size_t kFace = 0, kShirt = 1;  // places among the members

}  // namespace

std::string_view to_string(PersonSource source) {
  switch (source) {
    case PersonSource::kNone:
      return "none";
    case PersonSource::kFace:
      return "face";
    case PersonSource::kShirt:
      return "shirt";
  }
  return "";
}

std::optional<Classification> FaceClassifier::classify(const PersonImage& input) {
  if (!input.face) return std::nullopt;
  return Classification{input.face->match.label.value_or(kStranger), input.face->match.confidence};
}

PersonTracker::PersonTracker(const PersonTrackerParameters& parameters)
    : parameters_(parameters), shirts_(parameters.shirt) {
  feedback_.add(faces_, 0);
  feedback_.add(shirts_, 1);
}

bool PersonTracker::face_is_due() const {
  return shirts_.people() == 0 || since_face_ + 1 >= parameters_.faces_every;
}

PersonSighting PersonTracker::update(const PersonImage& input, const ImageContext& context) {
  const bool due = face_is_due();
  since_face_ = due ? 0 : since_face_ + 1;
  feedback_.require(kFace, due);
  feedback_.rely(kFace, reliability(Cue::kGrey, context, parameters_.context));
  feedback_.rely(kShirt, reliability(Cue::kColor, context, parameters_.context));
  const auto settled = feedback_.classify(input);
  if (due && input.face) shirts_.observe_face(input, *input.face);
  if (!settled) return {};
  PersonSighting sighting;
  sighting.person = settled->label;
  sighting.confidence = settled->confidence;
  const auto& face = feedback_.members()[kFace].answer;
  if (face && face->label == settled->label) {
    sighting.source = PersonSource::kFace;
    sighting.box = input.face->box;
  } else {
    sighting.source = PersonSource::kShirt;
    sighting.box = shirts_.box();
  }
  measure(input, sighting);
  return sighting;
}

// The height of a shirt changes least when its person turns.
void PersonTracker::measure(const PersonImage& input, PersonSighting& sighting) {
  constexpr double kNew = 0.1;  // share of a new ratio
  if (sighting.source == PersonSource::kShirt) {
    sighting.face_px = shirt_per_face_ > 0.0 ? sighting.box.height / shirt_per_face_ : face_px_;
    return;
  }
  face_px_ = sighting.face_px = sighting.box.width;
  const Box& shirt = shirts_.box();
  const auto& answer = feedback_.members()[kShirt].answer;
  const bool cut = shirt.y + shirt.height >= input.image.height_px;
  if (!answer || answer->label != sighting.person || cut) return;
  const double ratio = shirt.height / sighting.box.width;
  shirt_per_face_ = shirt_per_face_ > 0.0 ? (1.0 - kNew) * shirt_per_face_ + kNew * ratio : ratio;
}

}  // namespace cgsr::person
