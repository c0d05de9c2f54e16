#include "pipeline/illumination/shadow_brightness.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "pipeline/illumination/board.h"

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;
using U = ShadowBrightness;

const ShadowEdges kEdges{{0.01, -0.2}, 0.0006, -14.0};

struct Plain {
  double value;
  ShadowUnknowns by;  ///< its derivative; how an edge's softness changes with its place is left out.
};

/// The share of a ball that an edge hides, which the image blurs.
double hidden_by_edge(double d, double sigma, double penumbra, double& density) {
  const double x = d / sigma;
  const double lamp = penumbra * penumbra / (sigma * sigma);
  const double u = std::clamp(x / 2.0, -1.0, 1.0);
  const double disc = 0.5 + (u * std::sqrt(1.0 - u * u) + std::asin(u)) / std::numbers::pi;
  const double disc_density = std::sqrt(1.0 - u * u) / std::numbers::pi;
  const double gauss = 0.5 * std::erfc(-x / std::sqrt(2.0));
  const double gauss_density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
  const double mix = lamp * lamp;
  density = (gauss_density + mix * (disc_density - gauss_density)) / sigma;
  return gauss + mix * (disc - gauss);
}

/// The level where so much of the lamp is hidden, out of the light that is left: sRGB, above its linear foot.
double coded(double level, double dark, double hidden) {
  const double lit = std::pow(level - kEdges.zero, 2.4);
  const double in_shadow = std::pow(level - dark - kEdges.zero, 2.4);
  return kEdges.zero + std::pow(lit + hidden * (in_shadow - lit), 1.0 / 2.4);
}

/// The model as it is written down: a place at a time, and with the curves themselves instead of a table.
Plain plain_at(const ShadowUnknowns& x, const Vector2d& from_foot) {
  const Vector2d tip = x.segment<2>(U::kTipX);
  const Vector2d foot = x.segment<2>(U::kFootX);
  const Outline outline = outline_of(foot, x[U::kRadius], tip);
  const Vector2d q = kEdges.foot + from_foot - foot;
  double hidden = -1.0;
  ShadowUnknowns by_edge = ShadowUnknowns::Zero();
  for (std::size_t side = 0; side < 2; ++side) {
    const Vector2d line = tip - outline.touch[side];
    const double way = std::clamp(q.dot(line) / line.squaredNorm(), 0.0, 1.0);
    const double sigma = std::hypot(x[U::kSoftness] * way, kEdges.blur_m);
    const double d = q.dot(outline.inward[side]) + x[U::kRadius];
    double density = 0.0;
    hidden += hidden_by_edge(d, sigma, x[U::kSoftness] * way, density);
    // An edge that is held at the base and at the tip.
    by_edge.segment<2>(U::kTipX) -= density * way * outline.inward[side];
    by_edge.segment<2>(U::kFootX) -= density * (1.0 - way) * outline.inward[side];
    by_edge[U::kRadius] += density * (1.0 - way);
    by_edge[U::kSoftness] -= density * d * x[U::kSoftness] * way * way / (sigma * sigma);
  }
  hidden = std::max(0.0, hidden);
  const double level = x[U::kLevel];
  const double dark = x[U::kDark];
  Plain plain{coded(level, dark, hidden) + x.segment<2>(U::kSlopeX).dot(from_foot), ShadowUnknowns::Zero()};
  constexpr double kStep = 1e-4;
  const auto rise = [&](double by_level, double by_dark, double by_hidden) {
    return (coded(level + kStep * by_level, dark + kStep * by_dark, hidden + kStep * by_hidden) -
            coded(level - kStep * by_level, dark - kStep * by_dark, hidden - kStep * by_hidden)) /
           (2.0 * kStep);
  };
  if (hidden > 0.0) plain.by = rise(0.0, 0.0, 1.0) * by_edge;
  plain.by[U::kDark] = rise(0.0, 1.0, 0.0);
  plain.by[U::kLevel] = rise(1.0, 0.0, 0.0);
  plain.by.segment<2>(U::kSlopeX) = from_foot;
  return plain;
}

ShadowSums plain_sums(const ShadowUnknowns& x, const ShadowSamples& samples) {
  ShadowSums sums;
  const double scale = std::max(3.0, 0.12 * x[U::kDark]);
  for (std::size_t i = 0; i < static_cast<std::size_t>(samples.count); ++i) {
    const Plain at = plain_at(x, {static_cast<double>(samples.x[i]), static_cast<double>(samples.y[i])});
    const double residual = static_cast<double>(samples.value[i]) - at.value;
    if (samples.clipped[i] > 0.0F && residual < 0.0) continue;
    const double weight = 1.0 / (1.0 + residual * residual / (scale * scale));
    sums.H += weight * at.by * at.by.transpose();
    sums.g += weight * residual * at.by;
    sums.squares += weight * residual * residual;
    sums.weights += weight;
  }
  return sums;
}

TEST(ShadowBrightnessProperty, SumsAsTheModelWrittenDown) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const SoftStep step;
  for (int trial = 0; trial < 30; ++trial) {
    ShadowUnknowns x;
    const double way = 3.1 * unit(random);
    const Vector2d tip = kEdges.foot + (0.07 + 0.03 * unit(random)) * Vector2d(std::cos(way), std::sin(way));
    const bool is_deep = trial % 2 != 0;
    const double dark = !is_deep ? 30.0 + 20.0 * unit(random) : 100.0 + 45.0 * unit(random);
    x << tip, kEdges.foot + Vector2d(0.0005, -0.0003), 0.02, dark, 150.0, 40.0, -60.0, 0.0012 + 0.0001 * trial;
    ShadowSamples samples;
    const int count = 97 + trial % 4;  // not whole lanes alone
    while (samples.count < count) {
      const Vector2d at =
          0.5 * (1.0 + unit(random)) * (tip - kEdges.foot) + 0.02 * Vector2d(unit(random), unit(random));
      const bool is_clipped = samples.count % 5 == 0;
      double noise = 4.0 * unit(random);
      if (is_clipped) noise += std::copysign(1.0, noise);  // which side of the model it is on decides whether it counts
      samples.add(at.cast<float>(), static_cast<float>(plain_at(x, at).value + noise), is_clipped, 0);
    }
    const ShadowBrightness model(x, kEdges, step);
    ASSERT_TRUE(model.valid());
    const ShadowSums fast = model.sum_up(samples);
    const ShadowSums plain = plain_sums(x, samples);
    // The density out of the table has steps, which count more the farther from the edge a softness shows.
    const auto share = [](int unknown) { return unknown == U::kSoftness ? 0.1 : 0.05; };
    for (int a = 0; a < kShadowUnknowns; ++a) {
      for (int b = 0; b < kShadowUnknowns; ++b) {
        EXPECT_NEAR(fast.H(a, b), plain.H(a, b),
                    std::max(share(a), share(b)) * std::sqrt(plain.H(a, a) * plain.H(b, b)))
            << trial << ' ' << a << ' ' << b;
      }
      EXPECT_NEAR(fast.g[a], plain.g[a], share(a) * std::sqrt(plain.H(a, a) * plain.squares)) << trial << ' ' << a;
    }
    EXPECT_NEAR(fast.squares, plain.squares, (is_deep ? 0.02 : 0.01) * plain.squares);
    EXPECT_NEAR(fast.weights, plain.weights, 0.01 * plain.weights);
  }
}

TEST(ShadowSamples, ClipsWhatIsAtALevelOrAboveAndNothingElse) {
  ShadowSamples samples;
  samples.add({0.0F, 0.0F}, 100.0F, true, 0);  // a neighbour's noise
  samples.add({0.0F, 0.0F}, 200.0F, false, 0);
  samples.add({0.0F, 0.0F}, 220.0F, true, 0);
  samples.clip_at(200.0F);
  EXPECT_EQ(samples.clipped_count, 2);
  EXPECT_EQ(samples.clipped[0], 0.0F);
  EXPECT_EQ(samples.clipped[1], 1.0F);
  EXPECT_EQ(samples.value[0], 100.0F);
  EXPECT_EQ(samples.value[2], 200.0F);
}

TEST(ShadowBrightness, ATipOnTheBaseThrowsNoShadow) {
  ShadowUnknowns x;
  x << kEdges.foot + Vector2d(0.01, 0.0), kEdges.foot, 0.02, 30.0, 150.0, 0.0, 0.0, 0.0014;
  EXPECT_FALSE(ShadowBrightness(x, kEdges, SoftStep()).valid());
}

}  // namespace
}  // namespace cgsr::illumination
