#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/person/face/eye_detector.h"
#include "pipeline/person/face/face_descriptor.h"
#include "pipeline/person/face/face_recognizer.h"
#include "tests/person/drawn_face.h"

namespace cgsr::person {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr double kSize = 100.0;

EyeDetector eyes_of_debian() {
  return EyeDetector::from_cascade(text_of_cascade("haarcascade_eye.xml")).value();
}

cv::Mat with_a_face() {
  cv::Mat grey(kHeight, kWidth, CV_8U, cv::Scalar(150));
  draw_face(grey, 160, 120, kSize);
  return grey;
}

/// The same with skin where the eyes are: what a detector of faces takes for one now and then.
cv::Mat without_eyes() {
  cv::Mat grey = with_a_face();
  cv::rectangle(grey, {131, 95}, {189, 121}, 190, cv::FILLED);
  return grey;
}

GreyPatch crop_of(const cv::Mat& grey, double size = 1.0) {
  const double side = 0.8 * kSize * size;
  return face_crop({grey.data, grey.cols, grey.rows, static_cast<std::ptrdiff_t>(grey.step), PixelFormat::kGrey8},
                   {160 - side / 2, 122 - side / 2, side, side});
}

// A face is compared again and again, each time in another box; the drawn eyes are hardly like eyes.
TEST(EyeDetector, SeesAnEyeInOneOfAFewBoxesAtAnyContrast) {
  EyeDetector eyes = eyes_of_debian();
  for (const double contrast : {1.0, 0.5, 0.25}) {
    cv::Mat grey;
    with_a_face().convertTo(grey, CV_8U, contrast, 16.0);
    int seen = 0;
    for (const double size : {0.8, 1.0, 1.25}) seen += eyes.has_eye(crop_of(grey, size)) ? 1 : 0;
    EXPECT_GT(seen, 0) << contrast;
  }
}

TEST(EyeDetector, SeesNoneWhereThereIsNone) {
  EyeDetector eyes = eyes_of_debian();
  for (const double size : {0.8, 1.0, 1.25}) EXPECT_FALSE(eyes.has_eye(crop_of(without_eyes(), size))) << size;
  EXPECT_FALSE(eyes.has_eye({}));
  EXPECT_FALSE(eyes.has_eye({10, 10, std::vector<std::uint8_t>(100)}));
}

TEST(EyeDetector, SaysWhatIsWrongWithACascade) {
  const auto eyes = EyeDetector::from_cascade("nothing");
  ASSERT_FALSE(eyes);
  EXPECT_NE(eyes.error().message.find("not a cascade of OpenCV's"), std::string::npos) << eyes.error().message;
}

TEST(FaceTrainer, DoesNotCountAStrangerWithoutEyes) {
  FaceGallery gallery({.min_views = 1});
  cv::Mat other(kHeight, kWidth, CV_8U);
  cv::RNG(1).fill(other, cv::RNG::UNIFORM, 60, 200);
  gallery.enroll(1, view_of(*describe_crop(crop_of(other))));
  FaceTrainer asks(gallery, eyes_of_debian()), asks_not(gallery);
  const FaceQuestion face{1, crop_of(with_a_face())}, none{2, crop_of(without_eyes())};
  EXPECT_FALSE(asks.answer(face).match.label);
  EXPECT_TRUE(asks.answer(face).counts);
  EXPECT_FALSE(asks.answer(none).match.label);
  EXPECT_FALSE(asks.answer(none).counts);
  EXPECT_TRUE(asks_not.answer(none).counts);
}

TEST(FaceTrainer, CountsAStrangerThatHasShownAnEyeBefore) {
  FaceGallery gallery({.min_views = 1});
  cv::Mat other(kHeight, kWidth, CV_8U);
  cv::RNG(1).fill(other, cv::RNG::UNIFORM, 60, 200);
  gallery.enroll(1, view_of(*describe_crop(crop_of(other))));
  FaceTrainer trainer(gallery, eyes_of_debian());
  ASSERT_TRUE(trainer.answer({1, crop_of(with_a_face())}).counts);
  EXPECT_TRUE(trainer.answer({1, crop_of(without_eyes())}).counts);
  EXPECT_FALSE(trainer.answer({2, crop_of(without_eyes())}).counts) << "another face";
}

TEST(FaceTrainer, LooksForEyesTwiceInFiveAnswers) {
  FaceGallery gallery({.min_views = 1});
  cv::Mat other(kHeight, kWidth, CV_8U);
  cv::RNG(1).fill(other, cv::RNG::UNIFORM, 60, 200);
  gallery.enroll(1, view_of(*describe_crop(crop_of(other))));
  FaceTrainer trainer(gallery, eyes_of_debian());
  for (const std::uint32_t number : {1, 2}) EXPECT_FALSE(trainer.answer({number, crop_of(without_eyes())}).counts);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(trainer.answer({3, crop_of(with_a_face())}).counts) << i;
  EXPECT_TRUE(trainer.answer({3, crop_of(with_a_face())}).counts);
}

TEST(FaceTrainer, NamesWhoIsEnrolledWithOrWithoutEyes) {
  FaceGallery gallery({.min_views = 1});
  gallery.enroll(1, view_of(*describe_crop(crop_of(without_eyes()))));
  FaceTrainer trainer(gallery, eyes_of_debian());
  const FaceAnswer answer = trainer.answer({1, crop_of(without_eyes())});
  EXPECT_EQ(answer.match.label, 1);
  EXPECT_TRUE(answer.counts);
}

}  // namespace
}  // namespace cgsr::person
