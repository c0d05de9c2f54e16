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

const ShadowEdges kEdges{{0.01, -0.2}, 0.0006};

struct Plain {
  double value;
  ShadowUnknowns
      by;  ///< its derivative; how an edge's softness changes with its place, and the coding with the contrast, is left out.
};

/// The model as it is written down: a place at a time, and with the integral itself instead of a table.
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
    const double d = (q.dot(outline.inward[side]) + x[U::kRadius]) / sigma;
    const double density = std::exp(-0.5 * d * d) / (sigma * std::sqrt(2.0 * std::numbers::pi));
    hidden += 0.5 * std::erfc(-d / std::sqrt(2.0));
    // An edge that is held at the base and at the tip.
    by_edge.segment<2>(U::kTipX) -= density * way * outline.inward[side];
    by_edge.segment<2>(U::kFootX) -= density * (1.0 - way) * outline.inward[side];
    by_edge[U::kRadius] += density * (1.0 - way);
    by_edge[U::kSoftness] -= density * d * x[U::kSoftness] * way * way / sigma;
  }
  hidden = std::max(0.0, hidden);
  // The light that is left, as a camera codes it: by its square root.
  const double contrast = x[U::kDark] / x[U::kLevel];
  const double left = 1.0 - hidden * (1.0 - (1.0 - contrast) * (1.0 - contrast));
  const double coded = (1.0 - std::sqrt(left)) / contrast;
  const double slope = (1.0 - (1.0 - contrast) * (1.0 - contrast)) / (2.0 * contrast * std::sqrt(left));
  Plain plain{x[U::kLevel] + x.segment<2>(U::kSlopeX).dot(from_foot) - x[U::kDark] * coded, ShadowUnknowns::Zero()};
  if (hidden > 0.0) plain.by = -x[U::kDark] * slope * by_edge;
  plain.by[U::kDark] = -coded;
  plain.by[U::kLevel] = 1.0;
  plain.by.segment<2>(U::kSlopeX) = from_foot;
  return plain;
}

ShadowSums plain_sums(const ShadowUnknowns& x, const ShadowSamples& samples) {
  ShadowSums sums;
  const double scale = std::max(3.0, 0.12 * x[U::kDark]);
  for (std::size_t i = 0; i < static_cast<std::size_t>(samples.count); ++i) {
    const Plain at = plain_at(x, {static_cast<double>(samples.x[i]), static_cast<double>(samples.y[i])});
    const double residual = static_cast<double>(samples.value[i]) - at.value;
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
    x << tip, kEdges.foot + Vector2d(0.0005, -0.0003), 0.02, 30.0 + 20.0 * unit(random), 150.0, 40.0, -60.0,
        0.0012 + 0.0001 * trial;
    ShadowSamples samples;
    const int count = 97 + trial % 4;  // not whole lanes alone
    while (samples.count < count) {
      const Vector2d at =
          0.5 * (1.0 + unit(random)) * (tip - kEdges.foot) + 0.02 * Vector2d(unit(random), unit(random));
      samples.add(at.cast<float>(), static_cast<float>(plain_at(x, at).value + 4.0 * unit(random)), 0);
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
    EXPECT_NEAR(fast.squares, plain.squares, 0.01 * plain.squares);
    EXPECT_NEAR(fast.weights, plain.weights, 0.01 * plain.weights);
  }
}

TEST(ShadowBrightness, ATipOnTheBaseThrowsNoShadow) {
  ShadowUnknowns x;
  x << kEdges.foot + Vector2d(0.01, 0.0), kEdges.foot, 0.02, 30.0, 150.0, 0.0, 0.0, 0.0014;
  EXPECT_FALSE(ShadowBrightness(x, kEdges, SoftStep()).valid());
}

}  // namespace
}  // namespace cgsr::illumination
