#include "pipeline/person/face/face_recognizer.h"

#include <utility>

#include "pipeline/person/face/face_descriptor.h"
#include "platform/count_apart.h"

namespace cgsr::person {

FaceAnswer recognize(const FaceQuestion& question, const FaceGallery& gallery) {
  const auto descriptor = describe_crop(question.crop);
  return {question.face, descriptor ? gallery.identify(*descriptor) : FaceMatch{}};
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
