#include "hal/replay/bgr_to_yuyv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace cgsr::hal {
namespace {

struct Yuv {
  double y, u, v;
};

// ITU-R BT.601, limited range, in doubles.
Yuv formula(double b, double g, double r) {
  return {16 + (65.481 * r + 128.553 * g + 24.966 * b) / 255, 128 + (-37.797 * r - 74.203 * g + 112.0 * b) / 255,
          128 + (112.0 * r - 93.786 * g - 18.214 * b) / 255};
}

// Its inverse, solved from the same three equations, rounded and cut to 0..255.
std::array<int, 3> back_to_bgr(double y, double u, double v) {
  const double luma = 255.0 / 219.0 * (y - 16);
  const double r = luma + 255.0 / 112.0 * 0.701 * (v - 128);
  const double b = luma + 255.0 / 112.0 * 0.886 * (u - 128);
  const double g = (luma - 0.299 * r - 0.114 * b) / 0.587;
  const auto cut = [](double value) { return static_cast<int>(std::clamp(std::lround(value), 0L, 255L)); };
  return {cut(b), cut(g), cut(r)};
}

std::array<std::uint8_t, 4> convert_pair(std::array<std::uint8_t, 6> bgr) {
  std::array<std::uint8_t, 4> yuyv{};
  bgr_to_yuyv(bgr.data(), 6, 2, 1, yuyv.data(), 4);
  return yuyv;
}

// Every colour there is, as a pair of equal pixels: each value is the nearest integer to the formula.
TEST(BgrToYuyvProperty, EveryColourIsTheFormulaRounded) {
  double worst = 0;
  for (int b = 0; b < 256; ++b) {
    for (int g = 0; g < 256; ++g) {
      for (int r = 0; r < 256; r += 1) {
        const auto B = static_cast<std::uint8_t>(b), G = static_cast<std::uint8_t>(g), R = static_cast<std::uint8_t>(r);
        const auto got = convert_pair({B, G, R, B, G, R});
        const Yuv want = formula(b, g, r);
        worst = std::max({worst, std::abs(got[0] - want.y), std::abs(got[1] - want.u), std::abs(got[3] - want.v)});
        ASSERT_EQ(got[0], got[2]);
      }
    }
  }
  EXPECT_LE(worst, 0.501);
}

TEST(BgrToYuyvProperty, ChromaIsThatOfTheMeanOfTwoPixels) {
  std::mt19937 random(20261121);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int trial = 0; trial < 100'000; ++trial) {
    std::array<std::uint8_t, 6> p{};
    for (auto& value : p) value = static_cast<std::uint8_t>(byte(random));
    const auto got = convert_pair(p);
    const Yuv mean = formula((p[0] + p[3]) / 2.0, (p[1] + p[4]) / 2.0, (p[2] + p[5]) / 2.0);
    ASSERT_LE(std::abs(got[0] - formula(p[0], p[1], p[2]).y), 0.501);
    ASSERT_LE(std::abs(got[2] - formula(p[3], p[4], p[5]).y), 0.501);
    ASSERT_LE(std::abs(got[1] - mean.u), 0.501);
    ASSERT_LE(std::abs(got[3] - mean.v), 0.501);
  }
}

// What limited range costs: half a step of 1/219, 1/224 and 1/224 of the range, seen through the inverse.
TEST(BgrToYuyvProperty, RoundTripIsWithinTheQuantisation) {
  int worst = 0;
  for (int b = 0; b < 256; b += 3) {
    for (int g = 0; g < 256; g += 3) {
      for (int r = 0; r < 256; r += 3) {
        const auto B = static_cast<std::uint8_t>(b), G = static_cast<std::uint8_t>(g), R = static_cast<std::uint8_t>(r);
        const auto yuyv = convert_pair({B, G, R, B, G, R});
        const auto back = back_to_bgr(yuyv[0], yuyv[1], yuyv[3]);
        worst = std::max({worst, std::abs(back[0] - b), std::abs(back[1] - g), std::abs(back[2] - r)});
      }
    }
  }
  EXPECT_LE(worst, 2);
}

TEST(BgrToYuyv, KnownColours) {
  const auto of = [](std::uint8_t b, std::uint8_t g, std::uint8_t r) { return convert_pair({b, g, r, b, g, r}); };
  EXPECT_EQ(of(0, 0, 0), (std::array<std::uint8_t, 4>{16, 128, 16, 128}));
  EXPECT_EQ(of(255, 255, 255), (std::array<std::uint8_t, 4>{235, 128, 235, 128}));
  EXPECT_EQ(of(0, 0, 255), (std::array<std::uint8_t, 4>{81, 90, 81, 240}));   // red
  EXPECT_EQ(of(0, 255, 0), (std::array<std::uint8_t, 4>{145, 54, 145, 34}));  // green
  EXPECT_EQ(of(255, 0, 0), (std::array<std::uint8_t, 4>{41, 240, 41, 110}));  // blue
}

// Strides are respected and nothing beside the image is written.
TEST(BgrToYuyv, WritesTheImageAndNothingElse) {
  constexpr int kWidth = 6, kHeight = 3, kIn = 25, kOut = 19;
  std::vector<std::uint8_t> bgr(std::size_t{kIn} * kHeight, 255);
  std::vector<std::uint8_t> yuyv(std::size_t{kOut} * kHeight, 7);
  bgr_to_yuyv(bgr.data(), kIn, kWidth, kHeight, yuyv.data(), kOut);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kOut; ++x) {
      const int want = x >= 2 * kWidth ? 7 : x % 2 == 0 ? 235 : 128;
      ASSERT_EQ(yuyv[static_cast<std::size_t>(y * kOut + x)], want) << x << ',' << y;
    }
  }
}

}  // namespace
}  // namespace cgsr::hal
