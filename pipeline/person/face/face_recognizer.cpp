#include "pipeline/person/face/face_recognizer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/person/face/face_descriptor.h"
#include "platform/count_apart.h"

namespace cgsr::person {
namespace {

/// A face in a crop, cut as the enrolled ones lie, and whose it is.
struct Compared {
  FaceDescriptor face;
  FaceMatch match;
};

std::optional<Compared> compare(const GreyPatch& crop, const FaceGallery& gallery, std::optional<Label> without,
                                const LearnedViews& learned = {}) {
  auto face = describe_crop(crop);
  if (!face) return std::nullopt;
  FaceMatch match = gallery.identify(*face, without, learned);
  if (match.alignment.is_small()) return Compared{std::move(*face), match};
  auto aligned = describe_crop(aligned_crop(crop, match.alignment));
  if (!aligned) return Compared{std::move(*face), match};
  match = gallery.identify(*aligned, without, learned);
  return Compared{std::move(*aligned), match};
}

void allow_for_noise(double signal_to_noise, FaceMatch& match) {
  constexpr double kNothing = 2.0, kAll = 3.5;
  const double counted = std::clamp((signal_to_noise - kNothing) / (kAll - kNothing), 0.0, 1.0);
  // A confidence is 1 - exp(-x) / 2: x is counted in part.
  const auto less = [counted](double confidence) { return 1.0 - 0.5 * std::pow(2.0 * (1.0 - confidence), counted); };
  if (!match.label) match.confidence = less(match.confidence);
  if (match.rules_out > 0.0) match.rules_out = less(match.rules_out);
}

}  // namespace

FaceMatch identify_crop(const GreyPatch& crop, const FaceGallery& gallery, std::optional<Label> without) {
  const auto compared = compare(crop, gallery, without);
  return compared ? compared->match : FaceMatch{};
}

// In the order in which they were asked for, the latest last.
FaceTrainer::Followed& FaceTrainer::followed(std::uint32_t face) {
  auto place = std::ranges::find(followed_, face, &Followed::face);
  if (place == followed_.end()) {
    place = followed_.begin();
    *place = {.face = face};
  }
  std::rotate(place, place + 1, followed_.end());
  return followed_.back();
}

std::size_t FaceTrainer::learned(std::uint32_t face) const {
  const auto known = std::ranges::find(followed_, face, &Followed::face);
  return known == followed_.end() ? 0 : known->learned.size();
}

// Looked for until it was seen once: a face that has eyes keeps them.
bool FaceTrainer::has_eye(Followed& face, const GreyPatch& crop) {
  if (face.has_eye || !eyes_) return true;
  if (looked_for_eyes_.count() >= kMaxEyeLooks) return false;
  looked_for_eyes_.set(0);
  face.has_eye = eyes_->has_eye(crop);
  return face.has_eye;
}

FaceAnswer FaceTrainer::answer(const FaceQuestion& question) {
  constexpr double kSure = 2.0;  // of the least margin that names a face
  constexpr int kTwice = 2;
  looked_for_eyes_ <<= 1U;
  Followed& before = followed(question.face);
  auto compared = compare(question.crop, gallery_, std::nullopt, {before.person, before.learned});
  if (!compared) return {question.face, {}};
  const auto is_near = [&] {
    return FaceGallery::distance(compared->face, before.view) <= gallery_.parameters().max_step;
  };
  if (!before.learned.empty() && !is_near()) {
    before = {.face = question.face};  // somebody else has come before the face that was followed
    compared->match = gallery_.identify(compared->face);
  }
  FaceMatch& match = compared->match;
  allow_for_noise(question.signal_to_noise, match);
  const bool stranger = !match.label && match.confidence >= kClearConfidence;
  const FaceAnswer answer{question.face, match, !stranger || has_eye(before, question.crop)};
  if (match.margin <= 0.0) return answer;
  if (match.margin >= kSure * gallery_.parameters().min_margin) {
    if (match.nearest != before.person)
      before = {.face = question.face, .person = *match.nearest, .has_eye = before.has_eye};
    ++before.sure;
    before.view = view_of(compared->face);
  } else if (match.nearest == before.person && before.sure >= kTwice && is_near()) {
    before.view = view_of(compared->face);
    learn(before);
  }
  return answer;
}

void FaceTrainer::learn(Followed& face) const {
  const auto most = static_cast<std::size_t>(gallery_.parameters().max_learned_views);
  if (most == 0) return;
  if (face.learned.size() >= most) face.learned.erase(face.learned.begin());
  face.learned.push_back(face.view);
}

bool SteppedRecognizer::ask(FaceQuestion&& question) {
  if (question_) return false;
  question_ = std::move(question);
  images_left_ = images_;
  return true;
}

std::optional<FaceAnswer> SteppedRecognizer::answer() {
  if (!question_ || --images_left_ > 0) return std::nullopt;
  const CountApart apart("identify", "recognition");  // on a robot the thread of that name does it
  const FaceAnswer answer = trainer_.answer(*question_);
  question_.reset();
  return answer;
}

}  // namespace cgsr::person
