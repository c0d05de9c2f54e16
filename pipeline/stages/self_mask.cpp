#include "pipeline/stages/self_mask.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <Eigen/Core>

namespace cgsr::stages {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStep_m = 0.02;  // along an outline: a lens bends it

using Outline = std::vector<Vector2d>;

double distance_to(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double along = length2 > 0.0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - along * ab).norm();
}

bool within(const Outline& outline, const Vector2d& p, double margin_px) {
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d& a = outline[i];
    const Vector2d& b = outline[(i + 1) % outline.size()];
    if (distance_to(p, a, b) <= margin_px) return true;
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
      inside = !inside;
    }
  }
  return inside;
}

/// Corners joined by straight lines in space, in pixels.
Outline seen(const illumination::BoardView& view, std::span<const Vector3d> corners_B) {
  Outline outline;
  for (std::size_t i = 0; i < corners_B.size(); ++i) {
    const Vector3d& from = corners_B[i];
    const Vector3d& to = corners_B[(i + 1) % corners_B.size()];
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kStep_m)));
    outline.reserve(outline.size() + static_cast<std::size_t>(steps));
    for (int k = 0; k < steps; ++k) {
      const auto pixel = view.pixel(from + (to - from) * (static_cast<double>(k) / steps));
      if (pixel.in_front) outline.push_back(pixel.at);
    }
  }
  return outline;
}

}  // namespace

std::vector<std::uint8_t> self_mask(const illumination::Board& board, const geometry::Camera& camera,
                                    const geometry::Pose& X_RC, double margin_px) {
  const illumination::BoardView view(camera, board.X_RB.inverse() * X_RC);
  const double x = board.depth_m / 2;
  const double y = board.width_m / 2;
  const std::array<Vector3d, 4> face{Vector3d(-x, -y, 0.0), Vector3d(x, -y, 0.0), Vector3d(x, y, 0.0),
                                     Vector3d(-x, y, 0.0)};
  std::vector<Outline> outlines{seen(view, face)};
  for (int i = 0; i < board.probes; ++i) {
    const auto& probe = board.probe[static_cast<std::size_t>(i)];
    const Vector3d foot(probe.foot_B.x(), probe.foot_B.y(), 0.0);
    const Vector3d aside(0.0, probe.radius_m, 0.0);
    const std::array<Vector3d, 3> cone{probe.p_BA, foot - aside, foot + aside};
    outlines.push_back(seen(view, cone));
  }
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(camera.width_px) *
                                 static_cast<std::size_t>(camera.height_px));
  std::size_t at = 0;
  for (int row = 0; row < camera.height_px; ++row) {
    for (int column = 0; column < camera.width_px; ++column, ++at) {
      const bool own = std::any_of(outlines.begin(), outlines.end(), [&](const Outline& outline) {
        return within(outline, Vector2d(column, row), margin_px);
      });
      mask[at] = own ? 255 : 0;
    }
  }
  return mask;
}

}  // namespace cgsr::stages
