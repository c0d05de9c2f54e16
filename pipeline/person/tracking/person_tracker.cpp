#include "pipeline/person/tracking/person_tracker.h"

namespace cgsr::person {
namespace {

constexpr std::size_t kMarker = 0, kFace = 1, kShirt = 2;  // places among the members

}  // namespace

std::string_view to_string(PersonSource source) {
  switch (source) {
    case PersonSource::kNone:
      return "none";
    case PersonSource::kFace:
      return "face";
    case PersonSource::kShirt:
      return "shirt";
    case PersonSource::kMarker:
      return "marker";
  }
  return "";
}

std::optional<Classification> FaceClassifier::classify(const PersonImage& input) {
  if (!input.face) return std::nullopt;
  return Classification{input.face->match.label.value_or(kStranger), input.face->match.confidence};
}

std::optional<Classification> MarkerClassifier::classify(const PersonImage& input) {
  if (!input.marker) return std::nullopt;
  return Classification{input.marker->person.value_or(kStranger), input.marker->confidence};
}

PersonTracker::PersonTracker(const PersonTrackerParameters& parameters)
    : parameters_(parameters), shirts_(parameters.shirt) {
  feedback_.add(markers_, 0);
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
  feedback_.rely(kMarker, reliability(Cue::kGrey, context, parameters_.context));
  feedback_.rely(kFace, reliability(Cue::kGrey, context, parameters_.context));
  feedback_.rely(kShirt, reliability(Cue::kColor, context, parameters_.context));
  const auto settled = feedback_.classify(input);
  PersonImage looked_at = input;
  if (!due) looked_at.face.reset();
  shirts_.observe(looked_at);
  if (!settled) return {};
  PersonSighting sighting;
  sighting.person = settled->label;
  sighting.confidence = settled->confidence;
  const auto names_him = [&](std::size_t place) {
    const auto& answer = feedback_.members()[place].answer;
    return answer && answer->label == settled->label;
  };
  if (names_him(kMarker)) {
    sighting.source = PersonSource::kMarker;
    sighting.box = input.marker->box;
  } else if (names_him(kFace)) {
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
  face_px_ = sighting.face_px =
      sighting.source == PersonSource::kMarker ? input.marker->face.width : sighting.box.width;
  const Box& shirt = shirts_.box();
  const auto& answer = feedback_.members()[kShirt].answer;
  const bool cut = shirt.y + shirt.height >= input.image.height_px;
  if (!answer || answer->label != sighting.person || cut) return;
  const double ratio = shirt.height / sighting.face_px;
  shirt_per_face_ = shirt_per_face_ > 0.0 ? (1.0 - kNew) * shirt_per_face_ + kNew * ratio : ratio;
}

}  // namespace cgsr::person
