#include "pipeline/person/tracking/identifier.h"

#include <utility>

#include "pipeline/person/colors/color_histogram.h"

namespace cgsr::person {

Identifier::Identifier(FaceDetector detector, std::unique_ptr<FaceRecognizer> recognizer,
                       const IdentifierParameters& parameters)
    : faces_(std::move(detector), parameters.faces), recognizer_(std::move(recognizer)), tracker_(parameters.tracker) {}

void Identifier::exchange_with_recognizer(const ImageView& image) {
  if (const auto answer = recognizer_->answer()) {
    faces_.hear(*answer);
    asking_ = false;
  }
  if (asking_) return;
  auto question = faces_.question(image);
  if (!question) return;
  const std::uint32_t face = question->face;
  if (!recognizer_->ask(std::move(*question))) return;
  faces_.asked(face);
  asking_ = true;
}

// The face of the person of interest; the largest one that was compared where his is not followed. While it is followed and not seen in this image,
// the others are other people's and say nothing of him.
std::optional<FaceSighting> Identifier::face_of(std::optional<Label> interest) const {
  const FaceTrack* chosen = nullptr;
  const auto rank = [&](const FaceTrack& track) {
    return std::pair(interest && track.match->label == interest, track.box.area());
  };
  for (const FaceTrack& track : faces_.tracks()) {
    if (track.match && (chosen == nullptr || rank(track) > rank(*chosen))) chosen = &track;
  }
  if (chosen == nullptr || !chosen->seen) return std::nullopt;
  return FaceSighting{chosen->box, *chosen->match};
}

// Who is known by his shirt alone may be somebody else: his face is looked for first.
std::optional<Box> Identifier::face_above_shirt() const {
  constexpr double kAbove = 1.2;  // from the face's upper edge to the shirt's, in widths of the face
  if (last_.source != PersonSource::kShirt || last_.face_px <= 0.0) return std::nullopt;
  const double face_px = last_.face_px;
  const double middle = last_.box.x + last_.box.width / 2;
  return Box{middle - face_px / 2, last_.box.y - kAbove * face_px, face_px, face_px};
}

PeopleInView Identifier::identify(const ImageView& image, std::optional<Label> interest, WorkBudget& budget) {
  if (tracker_.face_is_due()) {
    faces_.look(image, budget, face_above_shirt());
  } else {
    faces_.pass(image, budget);
  }
  exchange_with_recognizer(image);
  // How the region was lit in which the person was last is how it is lit now.
  const ImageContext context = last_.box.empty() ? ImageContext{} : context_of(region_colors(image, last_.box));
  PeopleInView people;
  people.person = tracker_.update({image, face_of(interest)}, context);
  last_ = people.person;
  for (const FaceTrack& track : faces_.tracks()) {
    if (track.missed > 0) continue;
    SeenFace& face = people.faces[people.face_count++];
    face = {track.number, track.box, track.match.has_value(), std::nullopt, 0.0};
    if (!track.match) continue;
    face.person = track.match->label;
    face.confidence = track.match->confidence;
  }
  return people;
}

}  // namespace cgsr::person
