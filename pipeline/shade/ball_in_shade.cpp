#include "pipeline/shade/ball_in_shade.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace cgsr::shade {
namespace {

constexpr int kMostSteps = 16;  // along the ray, either way

/// Points on a circle, and its middle.
constexpr float kDiagonal = 0.70710678F;
constexpr std::array<std::array<float, 2>, 9> kOutline{{{0.0F, 0.0F},
                                                        {1.0F, 0.0F},
                                                        {kDiagonal, kDiagonal},
                                                        {0.0F, 1.0F},
                                                        {-kDiagonal, kDiagonal},
                                                        {-1.0F, 0.0F},
                                                        {-kDiagonal, -kDiagonal},
                                                        {0.0F, -1.0F},
                                                        {kDiagonal, -kDiagonal}}};

/// Is one of the rays to the outlines hidden by the map, or, if asked for, not hidden?
bool is_some_ray(bool hidden, const UncertainBall& ball, const LampView& lamp, const Eigen::Vector3f& p_WL) {
  const float outline_m = ball.radius_m + ball.across_m;
  // Both ways from the middle as far as it may be off, a step no longer than the outline is wide.
  const int steps = std::clamp(static_cast<int>(std::ceil(ball.along_m / std::max(outline_m, 1e-3F))), 0, kMostSteps);
  for (int i = -steps; i <= steps; ++i) {
    const float off_m = steps == 0 ? 0.0F : ball.along_m * static_cast<float>(i) / static_cast<float>(steps);
    const Eigen::Vector3f middle = ball.p_WB + off_m * ball.along;
    const Eigen::Vector3f to_lamp = p_WL - middle;
    const float lamp_m = to_lamp.norm();
    const float clear_m = outline_m + std::abs(off_m);
    if (!(lamp_m > clear_m)) {  // nothing is between
      if (!hidden) return true;
      continue;
    }
    const Eigen::Vector3f up = to_lamp / lamp_m;
    const Eigen::Vector3f u = up.unitOrthogonal();
    const Eigen::Vector3f v = up.cross(u);
    const Eigen::Vector3f before = middle + clear_m * up;
    for (const auto& [a, b] : kOutline) {
      if (lamp.look_at(before + outline_m * (a * u + b * v), world::kNone).hidden == hidden) return true;
    }
  }
  return false;
}

}  // namespace

bool may_lie_in_shade(const UncertainBall& ball, const LampView& lamp, const Eigen::Vector3f& p_WL) {
  return is_some_ray(true, ball, lamp, p_WL);
}

bool lies_in_shade(const UncertainBall& ball, const LampView& lamp, const Eigen::Vector3f& p_WL) {
  return !is_some_ray(false, ball, lamp, p_WL);
}

}  // namespace cgsr::shade
