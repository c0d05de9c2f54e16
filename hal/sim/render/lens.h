#pragma once

#include <vector>

#include <Eigen/Core>

#include "hal/sim/scene/camera_model.h"

namespace cgsr::sim {

/// Where a direction lands: (x, y, 1) in the camera's frame to pixels, distortion included.
Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector2d& xy);

/// The undistorted direction (x, y, 1) of a pixel position: Newton's method on `project`. Residual below 1e-9 pixels wherever the
/// distortion is one-to-one, which plausible lenses are over their image.
Eigen::Vector2d unproject(const CameraModel& camera, const Eigen::Vector2d& pixel);

/// The directions of all pixels, computed once.
class RayTable {
 public:
  explicit RayTable(const CameraModel& camera);

  /// Direction (x, y, 1) through a point `offset_px` from the centre of pixel (column, row), |offset| <= 0.5.
  [[nodiscard]] Eigen::Vector3f direction(int column, int row, const Eigen::Vector2f& offset_px) const {
    const Entry& e =
        entries_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column)];
    const Eigen::Vector2f xy = e.xy + offset_px.x() * e.per_column + offset_px.y() * e.per_row;
    return {xy.x(), xy.y(), 1.0F};
  }

 private:
  struct Entry {
    Eigen::Vector2f xy;
    Eigen::Vector2f per_column;  // change of xy over one pixel
    Eigen::Vector2f per_row;
  };
  int width_;
  std::vector<Entry> entries_;
};

}  // namespace cgsr::sim
