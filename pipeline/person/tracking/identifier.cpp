#include "pipeline/person/tracking/identifier.h"

#include <tuple>
#include <utility>

namespace cgsr::person {

namespace {

constexpr int kImagesToForget = 15;  // without the latest person of interest

}  // namespace

Identifier::Identifier(std::optional<FaceDetector> detector, std::unique_ptr<FaceRecognizer> recognizer,
                       const IdentifierParameters& parameters)
    : recognizer_(std::move(recognizer)), tracker_(parameters.tracker, parameters.faces.min_sure_confidence) {
  if (detector) faces_.emplace(std::move(*detector), parameters.faces);
  if (parameters.marker.enabled) markers_.emplace(parameters.marker);
}

void Identifier::look_for_faces(const ImageView& image, WorkBudget& budget) {
  if (!faces_) return;
  if (tracker_.face_is_due()) {
    faces_->look(image, budget, expected_face());
  } else {
    faces_->pass(image, budget);
  }
  exchange_with_recognizer(image);
}

void Identifier::exchange_with_recognizer(const ImageView& image) {
  if (const auto answer = recognizer_->answer()) {
    faces_->hear(*answer);
    asking_ = false;
  }
  if (asking_) return;
  auto question = faces_->question(image);
  if (!question) return;
  const std::uint32_t face = question->face;
  if (!recognizer_->ask(std::move(*question))) return;
  faces_->asked(face);
  asking_ = true;
}

// Whether a face is of somebody who stands beside the person of interest: it says nothing of him. A face above his shirt does. Where a task asks for somebody
// it is told at once who else is there; else the latest person of interest stays it until he is forgotten.
bool Identifier::is_beside(const FaceTrack& face, std::optional<Label> asked) const {
  const std::optional<Label> interest = asked ? asked : interest_;
  if (!interest || face.match->label == interest) return false;
  if (last_.source == PersonSource::kFaceColor && last_.person == interest)
    return intersection(face.box, last_.box).empty();
  const bool by_shirt = last_.source == PersonSource::kShirt;
  if (!by_shirt || (last_.person != interest && last_.person != kStranger)) return !asked;
  return !is_above(face.box, last_.box);
}

// The face of the person of interest; the largest one that was compared where his is not followed, somebody's who is known before a stranger's. While it is
// followed and not seen in this image, the others are other people's and say nothing of him.
std::optional<FaceSighting> Identifier::face_of(std::optional<Label> asked) const {
  const std::optional<Label> interest = asked ? asked : interest_;
  if (!faces_) return std::nullopt;
  const FaceTrack* chosen = nullptr;
  const auto rank = [&](const FaceTrack& track) {
    return std::tuple(interest && track.match->label == interest, track.match->label.has_value(), track.box.area());
  };
  for (const FaceTrack& track : faces_->tracks()) {
    if (!track.match || is_beside(track, asked)) continue;
    if (chosen == nullptr || rank(track) > rank(*chosen)) chosen = &track;
  }
  if (chosen == nullptr || !chosen->seen) return std::nullopt;
  return FaceSighting{chosen->box, *chosen->match};
}

// The marker of the person; somebody else's only where it is on the shirt that is taken for his, or no shirt is: beside it, it says nothing of him.
std::optional<MarkerSighting> Identifier::marker_of() const {
  if (!markers_) return std::nullopt;
  const auto marker = markers_->sighting();
  const Box& shirt = tracker_.shirts().box();
  if (!marker || marker->person || shirt.empty()) return marker;
  const double x = marker->box.x + marker->box.width / 2, y = marker->box.y + marker->box.height / 2;
  const double x_margin = marker->box.width,
               y_margin = marker->box.height;  // where the shirt's blob ends at the marker
  const bool on_it = x >= shirt.x - x_margin && x <= shirt.x + shirt.width + x_margin && y >= shirt.y - y_margin &&
                     y <= shirt.y + shirt.height + y_margin;
  return on_it ? marker : std::nullopt;
}

// Whoever was identified is of interest until he has not been for some images: one or two without him are no reason to turn to somebody else (6.2.2, the
// latest person of interest).
void Identifier::remember(const PersonSighting& now, std::optional<Label> asked) {
  const bool known = now.person && *now.person != kStranger;
  const bool stays = known && now.person == interest_;
  images_without_ = stays ? 0 : images_without_ + 1;
  if (asked) {
    interest_ = asked;
  } else if (known && (!interest_ || now.source == PersonSource::kFace || now.source == PersonSource::kMarker)) {
    interest_ = now.person;
    images_without_ = 0;
  } else if (images_without_ >= kImagesToForget) {
    interest_.reset();
  }
}

// Who is known by colours or a marker may be somebody else: his face is looked for first.
std::optional<Box> Identifier::expected_face() const {
  if (last_.source == PersonSource::kMarker) return last_marker_face_;
  if (last_.source == PersonSource::kFaceColor) return last_.box;
  if (last_.source != PersonSource::kShirt || last_.face_px <= 0.0) return std::nullopt;
  return face_above(last_.box, last_.face_px);
}

// Where a shirt or a head is not looked for anew, how the region was taken in which it was last is how it is now.
PersonContexts Identifier::contexts_of(const ImageView& image, const std::optional<FaceSighting>& face,
                                       const std::optional<MarkerSighting>& marker) const {
  const bool was_face = last_.source == PersonSource::kFace;
  const auto head = face ? std::optional(face->box) : was_face ? std::optional(last_.box) : expected_face();
  const Box& shirt = marker ? marker->box : tracker_.shirts().box();
  return {head ? context_of(image, *head) : ImageContext{}, shirt.empty() ? ImageContext{} : context_of(image, shirt)};
}

PeopleInView Identifier::identify(const ImageView& image, std::optional<Label> asked, WorkBudget& budget) {
  if (markers_) markers_->look(image, budget);
  look_for_faces(image, budget);
  PeopleInView people;
  const auto marker = marker_of();
  const auto face = face_of(asked);
  people.person = tracker_.update({image, face, asked ? asked : interest_, marker}, contexts_of(image, face, marker));
  last_ = people.person;
  last_marker_face_ = marker ? std::optional(marker->face) : std::nullopt;
  remember(last_, asked);
  if (last_.person != kStranger || last_.source == PersonSource::kShirt) people.expected_face = expected_face();
  if (!faces_) return people;
  for (const FaceTrack& track : faces_->tracks()) {
    if (track.missed > 0) continue;
    SeenFace& seen = people.faces[people.face_count++];
    seen = {track.number, track.box, track.match.has_value(), std::nullopt, 0.0};
    if (!track.match) continue;
    seen.person = track.match->label;
    seen.confidence = track.match->confidence;
  }
  return people;
}

}  // namespace cgsr::person
