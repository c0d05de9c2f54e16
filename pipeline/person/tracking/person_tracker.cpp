#include "pipeline/person/tracking/person_tracker.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace cgsr::person {
namespace {

constexpr std::size_t kMarker = 0, kFace = 1, kFaceColor = 2, kShirt = 3;  // places among the members

void follow_ratio(double& known, double now) {
  constexpr double kNew = 0.1;  // share of a new ratio
  known = known > 0.0 ? (1.0 - kNew) * known + kNew * now : now;
}

}  // namespace

std::string_view to_string(PersonSource source) {
  switch (source) {
    case PersonSource::kNone:
      return "none";
    case PersonSource::kFace:
      return "face";
    case PersonSource::kShirt:
      return "shirt";
    case PersonSource::kFaceColor:
      return "face color";
    case PersonSource::kMarker:
      return "marker";
  }
  return "";
}

std::optional<Classification> FaceClassifier::classify(const PersonImage& input) {
  if (!input.face) return std::nullopt;
  const FaceMatch& match = input.face->match;
  const bool of_another = input.interest && match.label != input.interest && match.nearest != input.interest;
  if (!of_another || (match.label && match.confidence >= min_sure_confidence_))
    return Classification{match.label.value_or(kStranger), match.confidence};
  // Whose it is is open, that it is not the person's is not.
  if (match.rules_out > match.confidence) return Classification{kStranger, match.rules_out};
  return Classification{match.label.value_or(kStranger), match.confidence};
}

std::optional<Classification> MarkerClassifier::classify(const PersonImage& input) {
  if (!input.marker) return std::nullopt;
  return Classification{input.marker->person.value_or(kStranger), input.marker->confidence};
}

Box face_above(const Box& shirt, double face_px) {
  constexpr double kAbove = 1.2;  // from the face's upper edge to the shirt's, in widths of the face
  const double middle = shirt.x + shirt.width / 2;
  return {middle - face_px / 2, shirt.y - kAbove * face_px, face_px, face_px};
}

bool is_above(const Box& face, const Box& shirt) {
  constexpr double kMostAbove = 2.0;  // of a face's upper edge above the shirt's, in widths of the face
  constexpr double kOfTrunk = 0.5;    // of the shirt, where a part of a trunk is followed
  const double middle = face.x + face.width / 2, above = shirt.y - face.y;
  if (middle < shirt.x || middle > shirt.x + shirt.width || above < 0.0) return false;
  return above <= kMostAbove * face.width || intersection(trunk_below(face), shirt).area() >= kOfTrunk * shirt.area();
}

PersonTracker::PersonTracker(const PersonTrackerParameters& parameters, double min_sure_confidence)
    : parameters_(parameters),
      labels_(parameters.shirt.max_width_px, parameters.shirt.max_height_px),
      faces_(min_sure_confidence),
      face_colors_(labels_, parameters.face_color),
      shirts_(labels_, parameters.shirt) {
  feedback_.add(markers_, 0);
  feedback_.add(faces_, 0);
  feedback_.add(face_colors_, 1);
  feedback_.add(shirts_, 1);
  sizes_.reserve(static_cast<std::size_t>(parameters.shirt.colors.max_people) + 1);
}

void PersonTracker::forget(Label person) {
  shirts_.forget(person);
  face_colors_.forget(person);
  if (by_face_ && by_face_->person == person) by_face_.reset();
  std::erase_if(sizes_, [person](const Size& one) { return one.person == person; });
}

bool PersonTracker::face_is_due() const {
  const bool no_shirt_yet = parameters_.shirt.enabled && shirts_.people() == 0;
  return no_shirt_yet || since_face_ + 1 >= parameters_.faces_every;
}

// A map costs as much as looking for faces: each is made in an image without faces, one at a time, in turns where both are due.
void PersonTracker::look_up(const ImageView& image, bool due) {
  if (!due || parameters_.faces_every == 1) {
    heads_first_ = !heads_first_;
    if (heads_first_) {
      if (!face_colors_.prepare()) shirts_.prepare();
    } else if (!shirts_.prepare()) {
      face_colors_.prepare();
    }
  }
  labels_.look(image);
}

PersonSighting PersonTracker::update(const PersonImage& input, const PersonContexts& contexts) {
  const bool due = face_is_due();
  since_face_ = due ? 0 : since_face_ + 1;
  look_up(input.image, due);
  feedback_.require(kFace, due);
  feedback_.rely(kMarker, reliability(Cue::kGrey, contexts.shirt, parameters_.context));
  feedback_.rely(kFace, reliability(Cue::kGrey, contexts.head, parameters_.context));
  feedback_.rely(kFaceColor, reliability(Cue::kColor, contexts.head, parameters_.context));
  feedback_.rely(kShirt, reliability(Cue::kColor, contexts.shirt, parameters_.context));
  PersonImage now = input;
  if (!due) now.face.reset();
  now.head = head_of(now);
  const auto settled = feedback_.classify(now);
  keep_face(now, due);
  shirts_.observe(now);
  if (now.face) face_colors_.observe_face(now, *now.face);
  if (!settled) return due || input.image.empty() ? PersonSighting{} : by_last_look();
  PersonSighting sighting;
  sighting.person = settled->label;
  sighting.confidence = settled->confidence;
  locate(input, settled->label, sighting);
  if (sighting.source == PersonSource::kFace) {
    by_face_ = sighting;
    since_by_face_ = 0;
  }
  if (is_below_other_face(sighting)) {
    sighting.person = by_face_->person;
    sighting.confidence = by_face_->confidence;
  } else if (sighting.source == PersonSource::kFaceColor) {
    shirts_.learn_negative();
  }
  measure(input, sighting);
  confirm_head(now, sighting);
  return sighting;
}

// By marker or face of this image, else where it was in the last one.
std::optional<PersonHead> PersonTracker::head_of(const PersonImage& input) const {
  std::optional<PersonHead> head = face_colors_.head();
  if (input.face && input.face->match.label) head = PersonHead{*input.face->match.label, input.face->box};
  if (input.marker && input.marker->person) head = PersonHead{*input.marker->person, input.marker->face};
  const bool of_somebody_else = head && input.interest && head->person != *input.interest;
  return of_somebody_else ? std::nullopt : head;
}

void PersonTracker::locate(const PersonImage& input, Label person, PersonSighting& sighting) const {
  const auto named_by = [&](std::size_t member) {
    const auto& answer = feedback_.members()[member].answer;
    return answer && answer->label == person;
  };
  if (named_by(kMarker)) {
    sighting.source = PersonSource::kMarker;
    sighting.box = input.marker->box;
  } else if (named_by(kFace)) {
    sighting.source = PersonSource::kFace;
    sighting.box = input.face->box;
  } else if (named_by(kShirt)) {
    sighting.source = PersonSource::kShirt;
    sighting.box = shirts_.box();
  } else {
    sighting.source = PersonSource::kFaceColor;
    sighting.box = face_colors_.head()->box;
  }
}

void PersonTracker::confirm_head(const PersonImage& input, const PersonSighting& sighting) {
  if (sighting.person == kStranger) return;
  if (sighting.source == PersonSource::kMarker) face_colors_.confirm(*sighting.person, input.marker->face);
  if (sighting.source == PersonSource::kFace) face_colors_.confirm(*sighting.person, sighting.box);
  if (sighting.source == PersonSource::kShirt && sighting.face_px > 0.0)
    face_colors_.confirm(*sighting.person, face_above(sighting.box, sighting.face_px));
}

// Between two looks for a face, where nothing else says who is there, whoever was named by the last one still is.
PersonSighting PersonTracker::by_last_look() const {
  if (!by_face_ || since_by_face_ > 0) return {};
  PersonSighting sighting = *by_face_;
  sighting.face_px = sighting.box.width;
  sighting.age_images = since_face_;
  return sighting;
}

// A stranger's face that is not found for some images, because the robot sways or he looks down, still is above the shirt that it was above.
void PersonTracker::keep_face(const PersonImage& input, bool due) {
  constexpr int kKept = 30;  // images
  const Box moved_from = std::exchange(shirt_before_, shirts_.box());
  if (!by_face_) return;
  const Box& shirt = shirt_before_;
  const bool is_followed =
      !shirt.empty() && !intersection(shirt, moved_from).empty() && is_above(by_face_->box, moved_from);
  const bool is_kept = by_face_->person == kStranger && !input.face && is_followed && ++since_by_face_ <= kKept;
  if (due && !is_kept) {
    by_face_.reset();
    return;
  }
  if (!is_followed) return;
  by_face_->box.x += shirt.x + shirt.width / 2 - (moved_from.x + moved_from.width / 2);
  by_face_->box.y += shirt.y - moved_from.y;
}

// Colours where the last face was a stranger's, or that of somebody who is dressed alike, are his until another face is seen there.
bool PersonTracker::is_below_other_face(const PersonSighting& sighting) const {
  if (!by_face_ || by_face_->person == sighting.person) return false;
  if (sighting.source == PersonSource::kShirt) return is_above(by_face_->box, sighting.box);
  return sighting.source == PersonSource::kFaceColor && !intersection(by_face_->box, sighting.box).empty();
}

// Of people whose shirts are known, and of whoever was measured last: bounded by the number of shirts.
PersonTracker::Size& PersonTracker::size_of(Label person) {
  if (const auto known = std::ranges::find(sizes_, person, &Size::person); known != sizes_.end()) return *known;
  std::erase_if(sizes_, [this](const Size& one) { return !shirts_.knows(one.person); });
  return sizes_.emplace_back(Size{.person = person});
}

// The height of a shirt changes least when its person turns. Where the image's border cuts it, it is at least as high as what is seen of it, and as wide: the
// larger of both says how near it is.
double PersonTracker::face_px_of_shirt(const ImageView& image, const Box& shirt, Label person) const {
  const auto size = std::ranges::find(sizes_, person, &Size::person);
  if (size == sizes_.end()) return 0.0;
  const auto face_by = [](double side, double per_face) { return per_face > 0.0 ? side / per_face : 0.0; };
  const double by_height = face_by(shirt.height, size->shirt_height_per_face);
  const bool is_whole = by_height > 0.0 && !is_cut_in_height(shirt, image);
  const double face_px = is_whole ? by_height : std::max(by_height, face_by(shirt.width, size->shirt_width_per_face));
  return face_px > 0.0 ? face_px : size->face_px;
}

void PersonTracker::measure(const PersonImage& input, PersonSighting& sighting) {
  if (sighting.source == PersonSource::kFaceColor) {
    sighting.face_px = sighting.box.width;
    return;
  }
  if (sighting.source == PersonSource::kShirt) {
    const auto by_place = shirts_.face_px();
    sighting.face_px = by_place ? *by_place : face_px_of_shirt(input.image, sighting.box, *sighting.person);
    return;
  }
  Size& size = size_of(*sighting.person);
  size.face_px = sighting.face_px =
      sighting.source == PersonSource::kMarker ? input.marker->face.width : sighting.box.width;
  const Box& shirt = shirts_.box();
  const auto& answer = feedback_.members()[kShirt].answer;
  if (!answer || answer->label != sighting.person) return;
  if (!is_cut_in_height(shirt, input.image)) follow_ratio(size.shirt_height_per_face, shirt.height / size.face_px);
  if (!is_cut_in_width(shirt, input.image)) follow_ratio(size.shirt_width_per_face, shirt.width / size.face_px);
}

}  // namespace cgsr::person
