#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/person/face/face_descriptor.h"
#include "pipeline/person/face/face_recognizer.h"

namespace cgsr::person {
namespace {

constexpr Box kFace{40, 40, 120, 120};

/// A texture of its own for each seed.
cv::Mat portrait(unsigned seed) {
  cv::RNG random(seed + 1);
  cv::Mat noise(20, 20, CV_8U), grey;
  random.fill(noise, cv::RNG::UNIFORM, 60, 200);
  cv::resize(noise, grey, {200, 200}, 0, 0, cv::INTER_CUBIC);
  return grey;
}

ImageView view_of_grey(const cv::Mat& grey) {
  return {grey.data, grey.cols, grey.rows, static_cast<std::ptrdiff_t>(grey.step), PixelFormat::kGrey8};
}

FaceGallery gallery_of_two() {
  FaceGallery gallery;
  for (const Label person : {1, 2}) {
    const auto face = describe_face(view_of_grey(portrait(static_cast<unsigned>(person))), kFace);
    for (int view = 0; view < 2; ++view) gallery.enroll(person, view_of(*face));
  }
  return gallery;
}

FaceQuestion question(std::uint32_t face, unsigned seed) {
  return {face, face_crop(view_of_grey(portrait(seed)), kFace)};
}

TEST(SteppedRecognizer, AnswersSoManyImagesAfterTheQuestionAndTakesOneAtATime) {
  SteppedRecognizer recognizer(gallery_of_two(), 3);
  EXPECT_FALSE(recognizer.answer());
  EXPECT_TRUE(recognizer.ask(question(7, 2)));
  EXPECT_FALSE(recognizer.ask(question(8, 1)));
  EXPECT_FALSE(recognizer.answer());
  EXPECT_FALSE(recognizer.answer());
  const auto answer = recognizer.answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->face, 7U);
  EXPECT_EQ(answer->match.label, 2);
  EXPECT_FALSE(recognizer.answer());
  EXPECT_TRUE(recognizer.ask(question(8, 1)));
}

TEST(SteppedRecognizer, SaysAStrangersWhereTheCropIsNone) {
  SteppedRecognizer recognizer(gallery_of_two(), 1);
  EXPECT_TRUE(recognizer.ask({1, {}}));
  const auto answer = recognizer.answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->match.label, std::nullopt);
}

TEST(FaceCrop, IsWhatTheFaceIsDescribedBy) {
  const cv::Mat image = portrait(3);
  const auto at_once = describe_face(view_of_grey(image), kFace);
  const auto later = describe_crop(face_crop(view_of_grey(image), kFace));
  ASSERT_TRUE(at_once && later);
  EXPECT_EQ(at_once->dense, later->dense);
  EXPECT_FALSE(describe_crop({}));
  EXPECT_FALSE(describe_crop({20, 20, std::vector<std::uint8_t>(400)}));
}

}  // namespace
}  // namespace cgsr::person
