#include "pipeline/imaging/color_code.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace cgsr::imaging {
namespace {

std::uint16_t code_of(double y, double u, double v) {
  return color_code(static_cast<int>(std::lround(4 * y)), static_cast<int>(std::lround(2 * u)),
                    static_cast<int>(std::lround(2 * v)));
}

TEST(ColorCode, KnowsTheCornersOfBt601) {
  const Rgb black = rgb_of_yuv(16, 128, 128);
  const Rgb white = rgb_of_yuv(235, 128, 128);
  const Rgb red = rgb_of_yuv(81.48, 90.20, 240.0);
  for (const double channel : {black.r, black.g, black.b, red.g, red.b}) EXPECT_NEAR(channel, 0.0, 1e-3);
  for (const double channel : {white.r, white.g, white.b, red.r}) EXPECT_NEAR(channel, 1.0, 1e-3);
}

TEST(ColorCode, CutsOffWhatNoCameraShouldSend) {
  const Rgb above = rgb_of_yuv(255, 255, 255);
  EXPECT_LE(above.r, 1.0);
  EXPECT_LE(above.b, 1.0);
  const Rgb below = rgb_of_yuv(0, 128, 128);
  EXPECT_EQ(below.r, 0.0);
}

TEST(ColorCodeProperty, YuvAndRgbAreInverse) {
  std::mt19937 random(20260101);
  std::uniform_real_distribution<double> channel(0.0, 1.0);
  for (int trial = 0; trial < 2000; ++trial) {
    const Rgb c{channel(random), channel(random), channel(random)};
    const Yuv yuv = yuv_of_rgb(c);
    const Rgb back = rgb_of_yuv(yuv.y, yuv.u, yuv.v);
    ASSERT_NEAR(back.r, c.r, 1e-9) << trial;
    ASSERT_NEAR(back.g, c.g, 1e-9) << trial;
    ASSERT_NEAR(back.b, c.b, 1e-9) << trial;
  }
}

// A grey stays grey, and half a level of noise in its chroma does not give it another code.
TEST(ColorCodeProperty, GreysAreGreyAndSteady) {
  for (double y = 16; y <= 235; y += 0.25) {
    const std::uint16_t code = code_of(y, 128, 128);
    const Rgb c = rgb_of_code(code);
    ASSERT_NEAR(c.r, c.g, 1e-9) << y;
    ASSERT_NEAR(c.b, c.g, 1e-9) << y;
    ASSERT_EQ(code_of(y, 130, 126), code) << y;
    ASSERT_EQ(code_of(y, 126, 130), code) << y;
  }
}

// The colour that stands for a code is no farther from any colour of the code than half a step of each of its parts allows.
TEST(ColorCodeProperty, TheMiddleOfACodeIsNear) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> y(16, 235);
  std::uniform_int_distribution<int> chroma(16, 240);
  for (int trial = 0; trial < 20000; ++trial) {
    const int u = chroma(random), v = chroma(random), luma = y(random);
    const std::uint16_t code = code_of(luma, u, v);
    ASSERT_LT(code, kColorCodes);
    const Rgb middle = rgb_of_code(code);
    const Rgb exact = rgb_of_yuv(luma, u, v);
    ASSERT_NEAR(middle.r, exact.r, 0.038) << trial;
    ASSERT_NEAR(middle.g, exact.g, 0.034) << trial;
    ASSERT_NEAR(middle.b, exact.b, 0.043) << trial;
  }
}

TEST(ColorCode, TheLargestSumsFit) {
  EXPECT_EQ(color_code(1020, 510, 510), kColorCodes - 1);
  EXPECT_EQ(color_code(0, 0, 0), 0);
}

}  // namespace
}  // namespace cgsr::imaging
