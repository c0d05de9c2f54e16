// Faces without faces: what describes and tells apart works on any texture, so these are drawn at random. Real ones: cgsr reproduce faces-caltech.

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/person/face/face_descriptor.h"
#include "pipeline/person/face/face_detector.h"
#include "pipeline/person/face/face_gallery.h"
#include "pipeline/person/face/grey_region.h"
#include "tests/person/drawn_face.h"

namespace cgsr::person {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr const char* kCascade = "/usr/share/opencv4/haarcascades/haarcascade_frontalface_alt2.xml";

ImageView view_of_grey(const cv::Mat& grey) {
  return {grey.data, grey.cols, grey.rows, static_cast<std::ptrdiff_t>(grey.step), PixelFormat::kGrey8};
}

// A texture of its own for each seed, in the middle of a grey image.
cv::Mat portrait(unsigned seed, double gain = 1.0, cv::Point shift = {0, 0}) {
  cv::RNG random(seed + 1);
  cv::Mat noise(12, 12, CV_32F), texture;
  random.fill(noise, cv::RNG::UNIFORM, 60.0, 200.0);
  cv::resize(noise, texture, {120, 120}, 0, 0, cv::INTER_CUBIC);
  cv::Mat image(kHeight, kWidth, CV_32F, cv::Scalar(120.0));
  texture.copyTo(image(cv::Rect(100 + shift.x, 60 + shift.y, 120, 120)));
  cv::Mat grey;
  image.convertTo(grey, CV_8U, gain);
  return grey;
}
const Box kFace{100, 60, 120, 120};

FaceDescriptor described(const cv::Mat& grey, const Box& face = kFace) {
  return describe_face(view_of_grey(grey), face).value_or(FaceDescriptor{});
}

FaceGallery gallery_of(int people, int views = 2, const FaceMatchParameters& parameters = {}) {
  FaceGallery gallery(parameters);
  for (int person = 0; person < people; ++person) {
    for (int view = 0; view < views; ++view) {
      gallery.enroll(person, view_of(described(portrait(static_cast<unsigned>(person), 1.0, {view, 0}))));
    }
  }
  return gallery;
}

// Textures are farther from each other than faces are, and the distances of one to several others differ more.
constexpr FaceMatchParameters kForTextures{.min_margin = 0.06};

TEST(FaceGallery, NamesAnEnrolledFaceInOtherLightAndALittleOff) {
  const auto gallery = gallery_of(6, 2, kForTextures);
  for (int person = 0; person < 6; ++person) {
    for (const double gain : {0.25, 0.6, 1.2}) {
      const auto match = gallery.identify(described(portrait(static_cast<unsigned>(person), gain, {4, -3})));
      EXPECT_EQ(match.label, person) << "gain " << gain << ", margin " << match.margin;
      EXPECT_GT(match.confidence, 0.5);
    }
  }
}

TEST(FaceGallery, CallsAnUnknownFaceAStrangerAndNotTheNearest) {
  for (const int people : {1, 2, 6}) {
    const auto gallery = gallery_of(people, 2, kForTextures);
    for (unsigned stranger = 100; stranger < 200; ++stranger) {
      const auto match = gallery.identify(described(portrait(stranger)));
      EXPECT_EQ(match.label, std::nullopt) << people << " people, margin " << match.margin;
      EXPECT_NE(match.nearest, std::nullopt);
    }
  }
}

// The geometric check: each half of the torn face is as near to its place as the whole one is that was moved, but no shift, turn or scale explains both.
TEST(FaceGallery, IsNearerToAFaceThatMovedAsAWholeThanToOneThatIsTorn) {
  FaceGallery gallery;
  for (int view = 0; view < 2; ++view) gallery.enroll(1, view_of(described(portrait(1))));
  for (const int off_px : {6, 8}) {
    const cv::Mat down = portrait(1, 1.0, {0, off_px}), up = portrait(1, 1.0, {0, -off_px});
    cv::Mat torn = down.clone();
    const cv::Rect right(kWidth / 2, 0, kWidth / 2, kHeight);
    up(right).copyTo(torn(right));
    const double whole = gallery.identify(described(down)).distance;
    EXPECT_GT(gallery.identify(described(torn)).distance, whole + 0.01) << off_px << " px";
  }
}

TEST(FaceGallery, LeavesOutWhoHasASingleView) {
  auto gallery = gallery_of(3, 1);
  EXPECT_EQ(gallery.identify(described(portrait(0))).label, std::nullopt);
  gallery.enroll(0, view_of(described(portrait(0))));
  EXPECT_EQ(gallery.identify(described(portrait(0))).label, 0);
}

TEST(FaceGallery, ForgetsAPersonAndKeepsAtMostSoManyViews) {
  auto gallery = gallery_of(2, 30);
  ASSERT_NE(gallery.views_of(1), nullptr);
  EXPECT_EQ(gallery.views_of(1)->size(), 6U);
  EXPECT_TRUE(gallery.forget(1));
  EXPECT_FALSE(gallery.forget(1));
  EXPECT_EQ(gallery.views_of(1), nullptr);
  EXPECT_EQ(gallery.identify(described(portrait(1))).label, std::nullopt);
}

TEST(FaceGallery, NamesOneOfAThousand) {
  FaceMatchParameters parameters;
  parameters.min_views = 1;
  FaceGallery gallery(parameters);
  const FaceView other = view_of(described(portrait(7)));
  for (int person = 0; person < 1000; ++person) {
    FaceView view = other;
    std::mt19937 random(static_cast<unsigned>(person));
    for (std::uint8_t& value : view) value = static_cast<std::uint8_t>(value / 2 + random() % 24);
    gallery.enroll(person, view);
  }
  gallery.enroll(1000, view_of(described(portrait(3))));
  EXPECT_EQ(gallery.identify(described(portrait(3))).label, 1000);
  EXPECT_EQ(gallery.people(), 1001U);
}

// Of many people only those who are roughly most alike are compared well: the answer is that of comparing all, also for a face that lies a little off.
TEST(FaceGallery, AnswersTheSameWhereOnlyTheMostAlikeAreCompared) {
  constexpr int kPeople = 60;
  const FaceGallery all = gallery_of(kPeople);
  for (int person = 0; person < kPeople; person += 7) {
    const auto face = described(portrait(static_cast<unsigned>(person), 0.8, {5, -4}));
    const FaceMatch match = all.identify(face);
    EXPECT_EQ(match.label, person);
    double nearest_other = 1.0;
    for (int one = 0; one < kPeople; ++one) {
      FaceGallery alone;
      for (const FaceView& view : *all.views_of(one)) alone.enroll(one, view);
      const double distance = alone.identify(face).distance;
      if (one == person)
        EXPECT_EQ(distance, match.distance);
      else
        nearest_other = std::min(nearest_other, distance);
    }
    EXPECT_NEAR(match.margin, nearest_other - match.distance, 0.02) << "the nearest other may not be among them";
  }
}

TEST(FaceDescriptor, OfAnEmptyCropOrOneOutsideIsNothing) {
  const cv::Mat grey = portrait(0);
  EXPECT_FALSE(describe_face(view_of_grey(grey), {}));
  EXPECT_FALSE(describe_face(view_of_grey(grey), {400, 10, 50, 50}));
  EXPECT_FALSE(describe_face({}, kFace));
  EXPECT_EQ(gallery_of(2).identify({}).label, std::nullopt);
}

TEST(FaceDescriptor, OfAFaceAtTheBorderIsFinite) {
  const cv::Mat grey = portrait(0);
  for (const Box& face : {Box{-30, -20, 100, 100}, Box{260, 180, 100, 100}, Box{0, 0, 3, 3}}) {
    const auto descriptor = describe_face(view_of_grey(grey), face);
    ASSERT_TRUE(descriptor);
    EXPECT_EQ(descriptor->dense.size(), std::size_t{kDenseSide} * kDenseSide * kSiftSize);
  }
}

// Sums that run along a line leave a little where there is nothing: no descriptor may come of it, nor of a deviation below zero.
TEST(FaceDescriptor, OfAFaceBeforeSaturatedWhiteIsThatOfTheFaceAlone) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const cv::Mat face = portrait(seed);
    cv::Mat grey(face.size(), CV_8UC1, cv::Scalar(255)), inside(face.size(), CV_8UC1, cv::Scalar(0));
    const cv::Point middle(static_cast<int>(kFace.x + kFace.width / 2), static_cast<int>(kFace.y + kFace.height / 2));
    const int half = static_cast<int>(kFace.width / 2);
    cv::ellipse(inside, middle, {half * 2 / 3, half}, 0.0, 0.0, 360.0, cv::Scalar(255), cv::FILLED);
    face.copyTo(grey, inside);
    const auto descriptor = describe_face(view_of_grey(grey), kFace);
    ASSERT_TRUE(descriptor);
    int described = 0;
    for (std::size_t point = 0; point < std::size_t{kDenseSide} * kDenseSide; ++point) {
      int square = 0;
      for (std::size_t i = 0; i < kSiftSize; ++i) {
        const int value = descriptor->dense[point * kSiftSize + i];
        square += value * value;
      }
      EXPECT_LT(square, 255 * 255 * 1.05) << seed << ": point " << point;
      described += square > 255 * 255 * 0.9 ? 1 : 0;
    }
    EXPECT_GT(described, kDenseSide * kDenseSide / 2) << seed;
  }
}

TEST(GreyRegion, IsTheMeanWhereItShrinksAndTheBorderOutside) {
  cv::Mat yuyv(4, 4, CV_8UC2, cv::Scalar(0, 128));
  yuyv.row(0).setTo(cv::Scalar(100, 0));
  yuyv.row(1).setTo(cv::Scalar(50, 0));
  const ImageView image{yuyv.data, 4, 4, static_cast<std::ptrdiff_t>(yuyv.step), PixelFormat::kYuyv};
  const GreyPatch half = grey_region(image, {0, 0, 4, 4}, 2, 2);
  EXPECT_EQ(half.pixels, (std::vector<std::uint8_t>{75, 75, 0, 0}));
  const GreyPatch above = grey_region(image, {0, -2, 4, 4}, 4, 4);
  EXPECT_EQ(above.pixels[0], 100);
  EXPECT_EQ(above.pixels[4], 100);
  EXPECT_EQ(above.pixels[12], 50);
  EXPECT_TRUE(grey_region(image, {10, 10, 4, 4}, 4, 4).pixels.empty());
}

std::string cascade_text() {
  std::ifstream in(kCascade);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

// What is looked through for faces is cut more cheaply than what is described, and shows the same.
TEST(GreyRegion, IsNearlyTheSameWhereItIsCutQuickly) {
  const cv::Mat grey = portrait(3);
  const Box regions[] = {{0, 0, 320, 240}, {11, 7, 301, 211}, {-20, -10, 200, 150}, {100, 60, 50, 40}};
  for (const Box& region : regions) {
    for (const double scale : {0.2, 0.45, 0.8, 1.6}) {
      const int width = static_cast<int>(region.width * scale), height = static_cast<int>(region.height * scale);
      const GreyPatch exact = grey_region(view_of_grey(grey), region, width, height);
      const GreyPatch quick = quick_grey_region(view_of_grey(grey), region, width, height);
      ASSERT_EQ(quick.pixels.size(), exact.pixels.size());
      double off = 0.0;
      for (std::size_t i = 0; i < exact.pixels.size(); ++i)
        off += std::abs(int{exact.pixels[i]} - int{quick.pixels[i]});
      EXPECT_LT(off / static_cast<double>(exact.pixels.size()), 8.0) << region.x << ' ' << scale;
    }
  }
  EXPECT_TRUE(quick_grey_region(view_of_grey(grey), {400, 0, 20, 20}, 10, 10).pixels.empty());
  EXPECT_TRUE(quick_grey_region({}, {0, 0, 20, 20}, 10, 10).pixels.empty());
}

TEST(GreyRegion, IsStretchedByNoMoreThanIsAskedAndWithoutASingleBrightPixel) {
  GreyPatch patch{100, 10, std::vector<std::uint8_t>(1000, 100)};
  for (std::size_t i = 0; i < 500; ++i) patch.pixels[i] = 120;
  patch.pixels[999] = 255;
  GreyPatch much = patch;
  stretch_contrast(patch, 3.0);
  EXPECT_EQ(patch.pixels[700], 0);
  EXPECT_EQ(patch.pixels[0], 60);
  EXPECT_EQ(patch.pixels[999], 255);
  stretch_contrast(much, 100.0);
  EXPECT_EQ(much.pixels[0], 255);
  GreyPatch plain{2, 2, {7, 7, 7, 7}}, nothing;
  stretch_contrast(plain, 3.0);
  stretch_contrast(nothing, 3.0);
  EXPECT_EQ(plain.pixels, (std::vector<std::uint8_t>{0, 0, 0, 0}));
  EXPECT_TRUE(nothing.pixels.empty());
}

// Of a face in so little light the grey values deviate by less than ten, which the cascade alone passes over.
TEST(FaceDetector, FindsAFaceOfLittleContrast) {
  FaceDetector detector = detector_of_debian();
  cv::Mat bright(480, 640, CV_8UC1, cv::Scalar(120));
  draw_face(bright, 300, 200, 110);
  std::size_t found = 0;
  for (const double contrast : {1.0, 0.5, 0.25, 0.15}) {
    cv::Mat grey;
    bright.convertTo(grey, CV_8U, contrast, 20.0);
    found += detector.find_all(view_of_grey(grey)).size() == 1 ? 1 : 0;
    const auto near = detector.find_near(view_of_grey(grey), {240, 140, 120, 120});
    ASSERT_TRUE(near) << contrast;
    EXPECT_NEAR(near->x + near->width / 2, 300, 15);
  }
  EXPECT_EQ(found, 4U);
}

TEST(FaceDetector, LooksThroughAWholeImageInAFewSteps) {
  const auto detector = FaceDetector::from_cascade(cascade_text(), {});
  ASSERT_TRUE(detector) << detector.error().message;
  const std::size_t steps = detector->round_of(640, 480).size();
  EXPECT_LE(steps, 35U) << "two in an image are half a second";
  EXPECT_GE(steps, 10U) << "no step may take the time of an image";
  EXPECT_TRUE(detector->round_of(20, 20).empty()) << "no face of 40 px is in it";
}

bool is_within(const Box& face, const Box& region) {
  return face.x >= region.x && face.y >= region.y && face.x + face.width <= region.x + region.width &&
         face.y + face.height <= region.y + region.height;
}

TEST(FaceDetector, HasEveryFaceWhollyInAStepOfARound) {
  const auto detector = FaceDetector::from_cascade(cascade_text(), {});
  ASSERT_TRUE(detector) << detector.error().message;
  const auto round = detector->round_of(640, 480);
  std::mt19937 random(20261126);
  for (const SearchStep& sought : round) {
    const double side = std::min(sought.max_face_px, 480.0);
    std::uniform_real_distribution<double> x(0.0, 640.0 - side), y(0.0, 480.0 - side);
    for (int trial = 0; trial < 200; ++trial) {
      const Box face{x(random), y(random), side, side};
      EXPECT_TRUE(std::ranges::any_of(round,
                                      [&](const SearchStep& step) {
                                        return step.min_face_px == sought.min_face_px && is_within(face, step.region);
                                      }))
          << face.x << ' ' << face.y << ' ' << side;
    }
  }
}

// What two steps share is searched twice: the largest face that may lie there, and a little more. The cost of a step is that of its region.
TEST(FaceDetector, LooksAtNoPartOfTheImageTwiceButForAFaceOnTheEdge) {
  const auto detector = FaceDetector::from_cascade(cascade_text(), {});
  ASSERT_TRUE(detector) << detector.error().message;
  const auto round = detector->round_of(640, 480);
  for (const SearchStep& step : round) {
    double right = 640.0;  // of the step: where the next one to the right begins
    for (const SearchStep& other : round) {
      const bool beside = other.min_face_px == step.min_face_px && other.region.y == step.region.y;
      if (beside && other.region.x > step.region.x) right = std::min(right, other.region.x);
    }
    EXPECT_LE(step.region.x + step.region.width - right, 1.3 * step.max_face_px) << step.region.x << ' ' << right;
  }
}

// A weak face is one in a few sizes and places only: rounds that look for the same ones would miss it for ever.
TEST(FaceDetector, LooksForOtherSizesAndAtOtherPlacesInEachOfEightRounds) {
  const auto detector = FaceDetector::from_cascade(cascade_text(), {});
  ASSERT_TRUE(detector) << detector.error().message;
  std::set<std::tuple<double, double, double>> looks;
  std::set<double> sizes;
  for (std::size_t round = 0; round < 8; ++round) {
    const SearchStep smallest = detector->round_of(640, 480, round).back();
    looks.insert({smallest.min_face_px, smallest.region.x, smallest.region.y});
    sizes.insert(smallest.min_face_px);
    const SearchStep again = detector->round_of(640, 480, round + 8).back();
    EXPECT_EQ(again.min_face_px, smallest.min_face_px);
  }
  EXPECT_EQ(looks.size(), 8U);
  ASSERT_EQ(sizes.size(), 2U);
  EXPECT_NEAR(*sizes.rbegin() / *sizes.begin(), std::sqrt(1.2), 1e-9) << "half a step";
}

TEST(FaceDetector, SaysWhatIsWrongWithACascade) {
  for (const char* text : {"", "nothing", "<?xml version=\"1.0\"?><opencv_storage></opencv_storage>",
                           "<?xml version=\"1.0\"?><opencv_storage><cascade><a>1</a></cascade></opencv_storage>"}) {
    const auto detector = FaceDetector::from_cascade(text, {});
    ASSERT_FALSE(detector) << text;
    EXPECT_NE(detector.error().message.find("cascade"), std::string::npos);
  }
}

// Enrolment and single images: the whole range of grey values is the room's, a twelfth of it the face's.
TEST(FaceDetector, FindsADarkFaceInABrightRoom) {
  auto detector = detector_of_debian();
  cv::Mat face(kHeight, kWidth, CV_8U, cv::Scalar(150)), grey;
  draw_face(face, 160, 130, 100.0);
  face.convertTo(grey, CV_8U, 0.08, 30.0);
  grey.rowRange(0, 50).setTo(235);
  grey.colRange(0, 100).setTo(235);
  grey.colRange(220, kWidth).setTo(235);
  EXPECT_TRUE(detector.find_all(view_of_grey(grey)).empty()) << "this test could not fail";
  const auto found = detector.find_all_dark(view_of_grey(grey));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(same_face(found.front(), {120, 92, 80, 80})) << found.front().x << ' ' << found.front().y;
}

TEST(FaceDetector, FindsNothingInAnEmptyOrPlainImage) {
  auto detector = FaceDetector::from_cascade(cascade_text(), {});
  ASSERT_TRUE(detector) << detector.error().message;
  EXPECT_TRUE(detector->find_all({}).empty());
  EXPECT_FALSE(detector->find_near({}, kFace));
  const cv::Mat plain(480, 640, CV_8UC1, cv::Scalar(90));
  EXPECT_TRUE(detector->find_all(view_of_grey(plain)).empty());
  EXPECT_TRUE(detector->find_all_dark({}).empty());
  EXPECT_TRUE(detector->find_all_dark(view_of_grey(plain)).empty());
  EXPECT_FALSE(detector->find_near(view_of_grey(plain), {600, 440, 80, 80}));
  EXPECT_FALSE(detector->find_near(view_of_grey(plain), {900, 440, 80, 80}));
}

}  // namespace
}  // namespace cgsr::person
