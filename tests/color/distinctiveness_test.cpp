#include "pipeline/color/learn/distinctiveness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "pipeline/color/learn/light.h"

namespace cgsr::color {
namespace {

std::vector<imaging::Rgb> half_and_half(const imaging::Rgb& a, const imaging::Rgb& b, double share_of_a,
                                        double noise = 0.0) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<imaging::Rgb> colors;
  for (int i = 0; i < 1000; ++i) {
    const auto& c = i < 1000 * share_of_a ? a : b;
    colors.push_back({c.r + noise * normal(random), c.g + noise * normal(random), c.b + noise * normal(random)});
  }
  return colors;
}

TEST(Distinctiveness, OneColourHasNone) {
  const imaging::Rgb red{0.8, 0.2, 0.1};
  EXPECT_DOUBLE_EQ(distinctiveness_of(half_and_half(red, red, 1.0)).divergence, 0.0);
  EXPECT_LT(distinctiveness_of(half_and_half(red, red, 1.0, 0.015)).divergence, 0.003);
  EXPECT_EQ(distinctiveness_of({}).max_share, 1.0);
}

TEST(Distinctiveness, ShadingIsNoSecondColour) {
  const imaging::Rgb light{0.8, 0.4, 0.2};
  const auto shaded = half_and_half(light, {light.r / 1.3, light.g / 1.3, light.b / 1.3}, 0.5);
  EXPECT_DOUBLE_EQ(distinctiveness_of(shaded).max_share, 1.0);
}

TEST(Distinctiveness, IsTheDivergenceFromTheLargerColour) {
  const auto two = distinctiveness_of(half_and_half({0.8, 0.2, 0.1}, {0.1, 0.2, 0.8}, 0.7));
  EXPECT_NEAR(two.max_share, 0.7, 1e-9);
  // Jensen-Shannon between (0.7, 0.3) and (1, 0), by hand.
  const double by_hand = 0.5 * (0.7 * std::log(0.7 / 0.85) + 0.3 * std::log(0.3 / 0.15)) + 0.5 * std::log(1.0 / 0.85);
  EXPECT_NEAR(two.divergence, by_hand, 1e-9);
}

TEST(DistinctivenessProperty, RisesAsTheSecondColourGrows) {
  double last = -1.0;
  for (double share = 1.0; share >= 0.5; share -= 0.05) {
    const double now = distinctiveness_of(half_and_half({0.8, 0.2, 0.1}, {0.1, 0.2, 0.8}, share)).divergence;
    EXPECT_GT(now, last - 1e-12) << share;
    last = now;
  }
  EXPECT_LT(last, std::numbers::ln2);
}

}  // namespace
}  // namespace cgsr::color
