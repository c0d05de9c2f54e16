#include "pipeline/person/context.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace cgsr::person {
namespace {

TEST(Context, AnUndisturbedImageTakesNothingAway) {
  EXPECT_EQ(reliability(Cue::kColor, {}), 1.0);
  EXPECT_EQ(reliability(Cue::kGrey, {}), 1.0);
}

TEST(Context, DarknessCostsColorMoreAndBlurCostsGreyMore) {
  EXPECT_LT(reliability(Cue::kColor, {.dark = 0.5}), reliability(Cue::kGrey, {.dark = 0.5}));
  EXPECT_LT(reliability(Cue::kGrey, {.blurred = 0.5}), reliability(Cue::kColor, {.blurred = 0.5}));
}

TEST(Context, EveryDisturbanceLowersAndNoneRaises) {
  for (const Cue cue : {Cue::kColor, Cue::kGrey}) {
    for (double share = 0.0; share < 1.0; share += 0.1) {
      const double next = share + 0.1;
      EXPECT_LE(reliability(cue, {.dark = next}), reliability(cue, {.dark = share}));
      EXPECT_LE(reliability(cue, {.saturated = next}), reliability(cue, {.saturated = share}));
      EXPECT_LE(reliability(cue, {.blurred = next}), reliability(cue, {.blurred = share}));
    }
    const double worst = reliability(cue, {.dark = 1.0, .saturated = 1.0, .blurred = 1.0});
    EXPECT_GE(worst, 0.0);
    EXPECT_LT(worst, 0.2);
  }
}

TEST(Context, OfARegionIsThatOfThePixelsWithinTheImage) {
  constexpr int kWidth = 64, kHeight = 48;
  std::vector<std::uint8_t> yuyv(std::size_t{2} * kWidth * kHeight, 128);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) yuyv[2 * static_cast<std::size_t>(y * kWidth + x)] = x < 32 ? 20 : 235;
  }
  const ImageView image{yuyv.data(), kWidth, kHeight, 2 * kWidth, PixelFormat::kYuyv};
  EXPECT_EQ(context_of(image, {0, 0, 32, 48}).dark, 1.0);
  EXPECT_EQ(context_of(image, {32, 0, 32, 48}).saturated, 1.0);
  EXPECT_NEAR(context_of(image, {0, 0, 64, 48}).dark, 0.5, 0.07);
  EXPECT_EQ(context_of(image, {-100, -100, 116, 116}).dark, 1.0) << "what is outside does not count";
  EXPECT_EQ(context_of(image, {-100, 0, 50, 48}).dark, 0.0);
  EXPECT_EQ(context_of(image, {}).dark, 0.0);
  EXPECT_EQ(context_of({}, {0, 0, 32, 48}).dark, 0.0);
  EXPECT_LT(mean_luma(image, {0, 0, 32, 48}), 0.1);
  EXPECT_GT(mean_luma(image, {32, 0, 32, 48}), 0.9);
  EXPECT_EQ(mean_luma(image, {-100, 0, 50, 48}), 1.0);
}

// A step in noise of a known deviation, and noise alone.
TEST(Context, StandsOutOfTheNoiseByWhatIsNotNoise) {
  constexpr int kWidth = 160, kHeight = 120;
  const auto ratio = [](double contrast, double noise) {
    std::mt19937 random(3);
    std::normal_distribution<double> deviate(0.0, 1.0);
    std::vector<std::uint8_t> yuyv(std::size_t{2} * kWidth * kHeight, 128);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double grey = 100.0 + contrast * (x < kWidth / 2 ? -1.0 : 1.0) + noise * deviate(random);
        yuyv[2 * static_cast<std::size_t>(y * kWidth + x)] = static_cast<std::uint8_t>(std::lround(grey));
      }
    }
    return signal_to_noise({yuyv.data(), kWidth, kHeight, 2 * kWidth, PixelFormat::kYuyv}, {10, 10, 140, 100});
  };
  EXPECT_NEAR(ratio(20.0, 2.0), 10.0, 2.0);
  EXPECT_NEAR(ratio(4.0, 4.0), 1.0, 0.3);
  EXPECT_LT(ratio(0.0, 4.0), 0.4);
  EXPECT_GT(ratio(30.0, 0.0), 20.0) << "grey values are rounded";
  EXPECT_EQ(ratio(0.0, 0.0), 0.0);
  EXPECT_EQ(signal_to_noise({}, {10, 10, 140, 100}), kNoNoise);
  const std::vector<std::uint8_t> grey(std::size_t{2} * kWidth * kHeight, 128);
  const ImageView yuyv{grey.data(), kWidth, kHeight, 2 * kWidth, PixelFormat::kYuyv};
  EXPECT_EQ(signal_to_noise(yuyv, {10, 10, 15, 100}), kNoNoise) << "too narrow";
  EXPECT_EQ(signal_to_noise(yuyv, {-100, 10, 110, 100}), kNoNoise) << "too narrow within the image";
  EXPECT_EQ(signal_to_noise(yuyv, {-20, -20, 400, 400}), 0.0) << "plain";
  EXPECT_EQ(signal_to_noise({grey.data(), kWidth, kHeight, kWidth, PixelFormat::kGrey8}, {10, 10, 140, 100}), kNoNoise);
}

// Bars two pixels wide, blurred along the rows by the mean of so many pixels: more and more is lost, and noise alone is not blurred.
TEST(Context, IsTheMoreBlurredTheWiderEdgesAre) {
  constexpr int kWidth = 96, kHeight = 48;
  const auto blurred_over = [](int pixels) {
    std::vector<std::uint8_t> yuyv(std::size_t{2} * kWidth * kHeight, 128);
    const auto bar = [](int x) { return (x / 24) % 2 == 0 ? 60.0 : 180.0; };
    for (int x = 0; x < kWidth; ++x) {
      double sum = 0.0;
      for (int i = 0; i < pixels; ++i) sum += bar(x + i);
      for (int y = 0; y < kHeight; ++y)
        yuyv[2 * static_cast<std::size_t>(y * kWidth + x)] = static_cast<std::uint8_t>(sum / pixels);
    }
    return context_of({yuyv.data(), kWidth, kHeight, 2 * kWidth, PixelFormat::kYuyv}, {0, 0, kWidth, kHeight}).blurred;
  };
  EXPECT_EQ(blurred_over(1), 0.0);
  EXPECT_GT(blurred_over(12), 0.1);
  EXPECT_GT(blurred_over(18), blurred_over(12));
}

TEST(Context, IsNotBlurredWhereNothingCanBeSaid) {
  const std::vector<std::uint8_t> yuyv(std::size_t{2} * 64 * 48, 128);
  const ImageView flat{yuyv.data(), 64, 48, 128, PixelFormat::kYuyv};
  EXPECT_EQ(blur_of(flat, {0, 0, 64, 48}), 0.0) << "no difference";
  EXPECT_EQ(blur_of(flat, {0, 0, 10, 48}), 0.0) << "too narrow";
  EXPECT_EQ(blur_of(flat, {100, 100, 64, 48}), 0.0) << "outside";
  EXPECT_EQ(blur_of({}, {0, 0, 64, 48}), 0.0);
}

}  // namespace
}  // namespace cgsr::person
