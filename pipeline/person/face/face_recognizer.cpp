#include "pipeline/person/face/face_recognizer.h"

#include <utility>

#include "pipeline/person/face/face_descriptor.h"
#include "platform/count_apart.h"

namespace cgsr::person {

FaceMatch identify_crop(const GreyPatch& crop, const FaceGallery& gallery, std::optional<Label> without) {
  const auto face = describe_crop(crop);
  if (!face) return {};
  const FaceMatch match = gallery.identify(*face, without);
  if (match.alignment.is_small()) return match;
  const auto aligned = describe_crop(aligned_crop(crop, match.alignment));
  return aligned ? gallery.identify(*aligned, without) : match;
}

FaceAnswer recognize(const FaceQuestion& question, const FaceGallery& gallery) {
  return {question.face, identify_crop(question.crop, gallery)};
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
  const FaceAnswer answer = recognize(*question_, gallery_);
  question_.reset();
  return answer;
}

}  // namespace cgsr::person
