#include "tests/illumination/rod_shadow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;

constexpr int kDirections = 1440;
constexpr double kFirst_px = 40.0;  // nearer the rod's own foot is seen
constexpr double kStep_px = 1.0;
constexpr double kBeside_px = 55.0;  // how bright the plane is
constexpr float kDarkShare = 0.65F;  // of that
constexpr double kLeastLength_px = 60.0;
constexpr int kMostGap = 3;             // steps that may be bright
constexpr double kRodHalfAngle = 0.45;  // about the direction of the rod itself

// Share of the brightness beside; 2 where it cannot be seen.
float share_at(const LumaView& image, const Vector2d& at, const Vector2d& across) {
  if (!image.holds(at.x(), at.y())) return 2.0F;
  float beside = 0.0F;
  for (const double side : {-1.0, 1.0}) {
    const Vector2d p = at + side * kBeside_px * across;
    if (image.holds(p.x(), p.y())) beside = std::max(beside, image.at(p.x(), p.y()));
  }
  if (beside < 8.0F) return 2.0F;
  return image.at(at.x(), at.y()) / beside;
}

}  // namespace

std::optional<Vector2d> find_rod_shadow(const LumaView& image, const Vector2d& base_px, const Vector2d& top_px) {
  const Vector2d rod = top_px - base_px;
  const double rod_angle = std::atan2(rod.y(), rod.x());
  // A rod that points at the camera covers what is around its base.
  const double first = rod.norm() < 2.0 * kFirst_px ? kFirst_px + rod.norm() : kFirst_px;
  double longest = first + kLeastLength_px;
  std::optional<Vector2d> tip;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kDirections;
    if (rod.norm() > kFirst_px && std::abs(std::remainder(angle - rod_angle, 2.0 * std::numbers::pi)) < kRodHalfAngle)
      continue;
    const Vector2d way(std::cos(angle), std::sin(angle));
    const Vector2d across(-way.y(), way.x());
    double end = 0.0;
    int gap = 0;
    float before = 2.0F;
    for (double length = first; gap <= kMostGap; length += kStep_px) {
      const float share = share_at(image, base_px + length * way, across);
      if (share < kDarkShare) {
        gap = 0;
        end = length;
      } else {
        // Where it crosses, between the last dark step and this one.
        if (gap == 0 && before < kDarkShare && share < 1.9F) {
          end += kStep_px * static_cast<double>((kDarkShare - before) / (share - before));
        }
        ++gap;
      }
      before = share;
    }
    if (end <= longest) continue;
    longest = end;
    tip = base_px + end * way;
  }
  return tip;
}

}  // namespace cgsr::illumination
