#include "pipeline/localization/localizer.h"

#include <vector>

#include <gtest/gtest.h>

#include "pipeline/localization/work.h"
#include "tests/localization/localizer_cases.h"

namespace cgsr::localization {
namespace {

using geometry::Pose;
using testing::answer_of;
using testing::error_of;
using testing::in_small_room;
using testing::kTracking;
using testing::Picture;
using testing::RandomNumbers;
using testing::room_camera;
using testing::small_room;

class LocalizerFault : public ::testing::Test {
 protected:
  LocalizerFault() : map_(small_room()), camera_(room_camera()), localizer_(map_, camera_, {}) {
    prior_ = prior_at(in_small_room(1.0, 1.6, 0.2), kTracking);
  }
  void expect_untouched(const std::vector<std::uint8_t>& pixels, Reason reason) {
    const ImageView image{
        .data = pixels.data(), .width_px = 320, .height_px = 240, .stride_bytes = 320, .format = PixelFormat::kGrey8};
    expect_untouched(image, reason);
  }
  void expect_untouched(const ImageView& image, Reason reason) {
    UnlimitedBudget budget;
    const Correction answer = localizer_.correct(image, prior_, budget);
    EXPECT_FALSE(answer.corrected);
    EXPECT_EQ(answer.reason, reason) << to_string(answer.reason);
    EXPECT_TRUE(answer.X_WC.isApprox(prior_.X_WC, 0.0));
    EXPECT_TRUE(answer.covariance.isApprox(prior_.covariance, 0.0));
  }

  world::Map map_;
  geometry::Camera camera_;
  Localizer localizer_;
  Prior prior_;
};

TEST_F(LocalizerFault, BlackSaturatedAndFeaturelessImagesAreNamed) {
  std::vector<std::uint8_t> pixels(320 * 240, 3);
  expect_untouched(pixels, Reason::kTooDark);
  std::fill(pixels.begin(), pixels.end(), std::uint8_t{255});
  expect_untouched(pixels, Reason::kTooBright);
  std::fill(pixels.begin(), pixels.end(), std::uint8_t{120});
  expect_untouched(pixels, Reason::kTooFewEdges);
}

TEST_F(LocalizerFault, AHandBeforeTheCameraIsNotAPose) {
  Picture picture(map_, prior_.X_WC, camera_, 1.5, 5);
  for (std::size_t y = 0; y < 240; ++y)
    for (std::size_t x = 0; x < 320; ++x)
      if (y > 20 || x > 60) picture.pixels[y * 320 + x] = static_cast<std::uint8_t>(140 + (x + y) / 40);
  UnlimitedBudget budget;
  const Correction answer = localizer_.correct(picture.view(), prior_, budget);
  EXPECT_FALSE(answer.corrected);
  EXPECT_TRUE(answer.reason == Reason::kTooFewEdges || answer.reason == Reason::kUnexplained ||
              answer.reason == Reason::kTooFewMatches)
      << to_string(answer.reason);
  EXPECT_TRUE(answer.X_WC.isApprox(prior_.X_WC, 0.0));
}

TEST_F(LocalizerFault, MotionBlurEitherCorrectsRightlyOrNotAtAll) {
  Picture picture(map_, prior_.X_WC, camera_, 1.5, 6);
  std::vector<std::uint8_t> blurred = picture.pixels;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      int sum = 0;
      for (int k = -25; k <= 25; ++k)
        sum += picture.pixels[static_cast<std::size_t>(y * 320 + std::clamp(x + k, 0, 319))];
      blurred[static_cast<std::size_t>(y * 320 + x)] = static_cast<std::uint8_t>(sum / 51);
    }
  }
  const ImageView image{
      .data = blurred.data(), .width_px = 320, .height_px = 240, .stride_bytes = 320, .format = PixelFormat::kGrey8};
  UnlimitedBudget budget;
  const Correction answer = localizer_.correct(image, prior_, budget);
  EXPECT_LT(error_of(prior_.X_WC, answer.X_WC).position_m, 0.03);
  EXPECT_NE(answer.corrected, answer.reason != Reason::kNone);
}

TEST_F(LocalizerFault, AnotherSizeAnotherFormatAndNoImageAreNamed) {
  const std::vector<std::uint8_t> pixels(640 * 480 * 3, 100);
  expect_untouched(
      {.data = pixels.data(), .width_px = 300, .height_px = 240, .stride_bytes = 300, .format = PixelFormat::kGrey8},
      Reason::kWrongSize);
  expect_untouched(
      {.data = pixels.data(), .width_px = 320, .height_px = 240, .stride_bytes = 960, .format = PixelFormat::kBgr24},
      Reason::kWrongSize);
  expect_untouched(ImageView{}, Reason::kWrongSize);
}

TEST_F(LocalizerFault, AMapOfAnotherRoomIsNotBelieved) {
  const Picture picture(map_, in_small_room(1.6, 2.4, 2.2), camera_, 1.5, 7);
  RandomNumbers random(14);
  LocalizerParameters parameters;
  parameters.hypotheses_per_image = 0;
  Localizer localizer(map_, camera_, parameters);
  int images = 0;
  const Correction answer = answer_of(localizer, picture.view(), prior_at(prior_.X_WC, PriorSigmas::floor()), images);
  EXPECT_FALSE(answer.corrected);
}

TEST_F(LocalizerFault, NoBudgetIsNoAnswer) {
  class Nothing final : public WorkBudget {
   public:
    bool grant() override { return false; }
  } nothing;
  const Picture picture(map_, prior_.X_WC, camera_, 1.5, 8);
  const Correction answer = localizer_.correct(picture.view(), prior_, nothing);
  EXPECT_EQ(answer.reason, Reason::kNoBudget);
  EXPECT_TRUE(answer.X_WC.isApprox(prior_.X_WC, 0.0));
}

TEST_F(LocalizerFault, APriorThatIsNoneIsRefused) {
  const Picture picture(map_, prior_.X_WC, camera_, 1.5, 9);
  UnlimitedBudget budget;
  Prior broken = prior_;
  broken.covariance.setZero();
  EXPECT_FALSE(localizer_.correct(picture.view(), broken, budget).corrected);
  broken = prior_;
  broken.X_WC.translation().x() = std::nan("");
  EXPECT_FALSE(localizer_.correct(picture.view(), broken, budget).corrected);
}

TEST(LocalizerEmptyFault, AMapWithoutEdgesIsNamed) {
  const world::Map map;
  Localizer localizer(map, room_camera(), {});
  const std::vector<std::uint8_t> pixels(320 * 240, 100);
  UnlimitedBudget budget;
  const Correction answer = localizer.correct(
      {.data = pixels.data(), .width_px = 320, .height_px = 240, .stride_bytes = 320, .format = PixelFormat::kGrey8},
      prior_at(Pose::Identity(), kTracking), budget);
  EXPECT_EQ(answer.reason, Reason::kNoMap);
}

}  // namespace
}  // namespace cgsr::localization
