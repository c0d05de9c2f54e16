#include "pipeline/geometry/camera.h"

#include <cmath>

#include <Eigen/LU>

namespace cgsr::geometry {

Eigen::Vector2d Camera::distorted(const Eigen::Vector2d& ideal) const {
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

std::optional<Eigen::Vector2d> Camera::pixel_of(const Eigen::Vector3d& p_C) const {
  if (!(p_C.z() > 1e-6)) return std::nullopt;
  const Eigen::Vector2d bent = distorted(p_C.head<2>() / p_C.z());
  return Eigen::Vector2d(fx_px * bent.x() + cx_px, fy_px * bent.y() + cy_px);
}

Eigen::Vector2d Camera::ideal_of(const Eigen::Vector2d& pixel) const {
  Eigen::Vector2d bent((pixel.x() - cx_px) / fx_px, (pixel.y() - cy_px) / fy_px);
  if (!has_distortion()) return bent;
  Eigen::Vector2d ideal = bent;
  for (int i = 0; i < 12; ++i) {
    const double x = ideal.x();
    const double y = ideal.y();
    const double r2 = x * x + y * y;
    const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double slope = 2.0 * (k1 + r2 * (2.0 * k2 + 3.0 * k3 * r2));  // d radial / d x = slope x
    Eigen::Matrix2d J;
    J(0, 0) = radial + x * slope * x + 2.0 * p1 * y + 6.0 * p2 * x;
    J(0, 1) = x * slope * y + 2.0 * p1 * x + 2.0 * p2 * y;
    J(1, 0) = y * slope * x + 2.0 * p1 * x + 2.0 * p2 * y;
    J(1, 1) = radial + y * slope * y + 6.0 * p1 * y + 2.0 * p2 * x;
    const double determinant = J.determinant();
    if (std::abs(determinant) < 1e-6) break;
    const Eigen::Vector2d error = distorted(ideal) - bent;
    const Eigen::Vector2d step((J(1, 1) * error.x() - J(0, 1) * error.y()) / determinant,
                               (J(0, 0) * error.y() - J(1, 0) * error.x()) / determinant);
    ideal -= step;
    if (step.squaredNorm() < 1e-22) break;
  }
  return ideal;
}

Eigen::Vector2d Camera::undistorted(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d ideal = ideal_of(pixel);
  return {fx_px * ideal.x() + cx_px, fy_px * ideal.y() + cy_px};
}

Camera Camera::scaled_to(int width, int height) const {
  Camera scaled = *this;
  const double sx = static_cast<double>(width) / width_px;
  const double sy = static_cast<double>(height) / height_px;
  scaled.width_px = width;
  scaled.height_px = height;
  scaled.fx_px *= sx;
  scaled.fy_px *= sy;
  scaled.cx_px = (cx_px + 0.5) * sx - 0.5;
  scaled.cy_px = (cy_px + 0.5) * sy - 0.5;
  return scaled;
}

Camera Camera::without_distortion() const {
  Camera plain = *this;
  plain.k1 = plain.k2 = plain.p1 = plain.p2 = plain.k3 = 0.0;
  return plain;
}

}  // namespace cgsr::geometry
