#include "pipeline/color/track/color_agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pipeline/color/track/light_estimate.h"

namespace cgsr::color {
namespace {

/// Stripes of three colours, with shares of their own.
ObjectView striped(const std::array<imaging::Rgb, 3>& colors, const std::array<double, 3>& shares) {
  ObjectView view;
  for (std::size_t i = 0; i < view.y.size(); ++i) {
    const double place = (static_cast<double>(i) + 0.5) / static_cast<double>(view.y.size());
    const std::size_t which = place < shares[0] ? 0 : place < shares[0] + shares[1] ? 1 : 2;
    const auto yuv = imaging::yuv_of_rgb(colors[which]);
    view.y[i] = static_cast<std::uint8_t>(std::lround(yuv.y));
    view.u[i] = static_cast<std::uint8_t>(std::lround(yuv.u));
    view.v[i] = static_cast<std::uint8_t>(std::lround(yuv.v));
  }
  return view;
}

constexpr imaging::Rgb kRed{0.7, 0.12, 0.1}, kBlue{0.1, 0.15, 0.6}, kBlack{0.1, 0.1, 0.1}, kSkin{0.7, 0.5, 0.4};
constexpr std::array kShares{0.4, 0.4, 0.2};

double agreement(const ObjectView& a, const ObjectView& b) {
  return ColorAmounts(a).agreement(ColorAmounts(b));
}

TEST(ColorAmounts, AgreeWithThemselvesAndInBothDirections) {
  const auto view = striped({kRed, kBlue, kSkin}, kShares);
  const auto other = striped({kBlack, kBlue, kSkin}, kShares);
  EXPECT_NEAR(agreement(view, view), 1.0, 1e-4);
  EXPECT_NEAR(agreement(view, other), agreement(other, view), 1e-6);
}

// What tells two people in the same trousers apart.
TEST(ColorAmounts, AMissingColorCosts) {
  const double same_trousers =
      agreement(striped({kRed, kBlue, kSkin}, kShares), striped({kBlack, kBlue, kSkin}, kShares));
  EXPECT_NEAR(same_trousers, 0.6, 0.1);
  EXPECT_LT(agreement(striped({kRed, kRed, kRed}, kShares), striped({kBlue, kBlue, kBlue}, kShares)), 0.05);
}

TEST(ColorAmounts, OtherAmountsOfTheSameColorsCostLittle) {
  const std::array colors{kRed, kBlue, kSkin};
  EXPECT_GT(agreement(striped(colors, kShares), striped(colors, {0.3, 0.45, 0.25})), 0.97);
}

// The light that light_gain finds is good enough to compare under.
TEST(ColorAmountsProperty, AgreeUnderAnotherLightThatIsTakenOut) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> level(0.3, 0.65);
  std::uniform_real_distribution<double> gain(0.7, 1.4);
  double taken_out = 0.0;
  double left_in = 0.0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto color = [&] { return imaging::Rgb{level(random), level(random), level(random)}; };
    const auto learned = striped({color(), color(), color()}, kShares);
    const auto seen = relit(learned, {gain(random), gain(random), gain(random)});
    const Light estimate = light_gain(channel_quantiles(learned), channel_quantiles(seen));
    taken_out += agreement(learned, relit(seen, without_light({1.0, 1.0, 1.0}, estimate))) / kTrials;
    left_in += agreement(learned, seen) / kTrials;
  }
  EXPECT_GT(taken_out, 0.95);
  EXPECT_LT(left_in, 0.5);
}

TEST(ObjectView, ShowsTheBoxWithoutItsOuterTenth) {
  std::vector<std::uint8_t> yuyv(std::size_t{160} * 120 * 2, 40);
  for (int y = 30; y < 70; ++y) {
    for (int x = 40; x < 100; ++x) yuyv[static_cast<std::size_t>((y * 160 + x) * 2)] = 200;
  }
  imaging::Pyramid pyramid(160, 120);
  pyramid.build(
      {.data = yuyv.data(), .width_px = 160, .height_px = 120, .stride_bytes = 320, .format = PixelFormat::kYuyv});
  const auto view = view_object(pyramid, {38, 28, 64, 44});  // a bit too large
  EXPECT_EQ(*std::min_element(view.y.begin(), view.y.end()), 200);
  EXPECT_EQ(*std::max_element(view.y.begin(), view.y.end()), 200);
}

}  // namespace
}  // namespace cgsr::color
