#include "hal/sim/render/lens.h"

#include <cstddef>

#include <Eigen/LU>

namespace cgsr::sim {
namespace {

struct Distorted {
  Eigen::Vector2d xy;
  Eigen::Matrix2d slope;  // d xy' / d xy
};

Distorted distort(const CameraModel& c, const Eigen::Vector2d& xy) {
  const double x = xy.x();
  const double y = xy.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  const double radial_slope = c.k1 + r2 * (2.0 * c.k2 + r2 * 3.0 * c.k3);  // d radial / d r2
  Distorted out;
  out.xy = {x * radial + 2.0 * c.p1 * x * y + c.p2 * (r2 + 2.0 * x * x),
            y * radial + c.p1 * (r2 + 2.0 * y * y) + 2.0 * c.p2 * x * y};
  const double cross = 2.0 * x * y * radial_slope + 2.0 * (c.p1 * x + c.p2 * y);
  out.slope << radial + 2.0 * x * x * radial_slope + 2.0 * c.p1 * y + 6.0 * c.p2 * x, cross, cross,
      radial + 2.0 * y * y * radial_slope + 6.0 * c.p1 * y + 2.0 * c.p2 * x;
  return out;
}

}  // namespace

Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector2d& xy) {
  const Eigen::Vector2d d = distort(camera, xy).xy;
  return {camera.fx_px * d.x() + camera.cx_px, camera.fy_px * d.y() + camera.cy_px};
}

Eigen::Vector2d unproject(const CameraModel& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d goal((pixel.x() - camera.cx_px) / camera.fx_px, (pixel.y() - camera.cy_px) / camera.fy_px);
  Eigen::Vector2d xy = goal;
  for (int i = 0; i < 12; ++i) {
    const Distorted d = distort(camera, xy);
    const Eigen::Vector2d step = d.slope.inverse() * (d.xy - goal);
    xy -= step;
    if (step.squaredNorm() < 1e-26) break;
  }
  return xy;
}

RayTable::RayTable(const CameraModel& camera) : width_(camera.width_px) {
  entries_.reserve(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px));
  for (int row = 0; row < camera.height_px; ++row) {
    for (int column = 0; column < camera.width_px; ++column) {
      const Eigen::Vector2d xy = unproject(camera, {column, row});
      Eigen::Matrix2d to_pixels = distort(camera, xy).slope;
      to_pixels.row(0) *= camera.fx_px;
      to_pixels.row(1) *= camera.fy_px;
      const Eigen::Matrix2d per_pixel = to_pixels.inverse();
      entries_.push_back({xy.cast<float>(), per_pixel.col(0).cast<float>(), per_pixel.col(1).cast<float>()});
    }
  }
}

}  // namespace cgsr::sim
