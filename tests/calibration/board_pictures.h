#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/calibration/board.h"
#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"

namespace cgsr::calibration::testing {

inline double uniform(std::mt19937& random, double from, double to) {
  return from + (to - from) * static_cast<double>(random()) / 4294967296.0;
}

inline double normal(std::mt19937& random) {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += uniform(random, 0.0, 1.0);
  return sum;
}

/// A camera that OpenCV has to find out about.
inline geometry::Camera true_camera() {
  geometry::Camera camera;
  camera.fx_px = 611.3;
  camera.fy_px = 605.9;
  camera.cx_px = 326.1;
  camera.cy_px = 231.4;
  camera.k1 = -0.21;
  camera.k2 = 0.08;
  camera.p1 = 0.0012;
  camera.p2 = -0.0008;
  return camera;
}

/// Poses of a board before the camera, its middle near the pixel that `part` of the image says, tilted by up to 35 degrees.
inline geometry::Pose board_before_camera(std::mt19937& random, const Board& board, const geometry::Camera& camera,
                                          double part_x, double part_y, double distance_m) {
  geometry::Pose X_CB = geometry::Pose::Identity();
  X_CB.linear() =
      geometry::rotation_of({uniform(random, -0.6, 0.6), uniform(random, -0.6, 0.6), uniform(random, -0.3, 0.3)});
  const Eigen::Vector3d middle_B(0.5 * (board.columns - 1) * board.square_m, 0.5 * (board.rows - 1) * board.square_m,
                                 0.0);
  const Eigen::Vector2d ideal = camera.ideal_of({part_x * camera.width_px, part_y * camera.height_px});
  X_CB.translation() = distance_m * Eigen::Vector3d(ideal.x(), ideal.y(), 1.0) - X_CB.linear() * middle_B;
  return X_CB;
}

/// The inner corners' true pixels; empty when one lies outside of the image.
inline std::vector<cv::Point2f> corners_of(const geometry::Pose& X_CB, const Board& board,
                                           const geometry::Camera& camera) {
  std::vector<cv::Point2f> out;
  for (const cv::Point3f& point : board.points()) {
    const auto pixel =
        camera.pixel_of(X_CB * Eigen::Vector3d(static_cast<double>(point.x), static_cast<double>(point.y), 0.0));
    if (!pixel || pixel->minCoeff() < 0.0 || pixel->x() > camera.width_px - 1 || pixel->y() > camera.height_px - 1)
      return {};
    out.emplace_back(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()));
  }
  return out;
}

/// Grey images of boards, as one camera takes them: its rays are computed once.
class Photographs {
 public:
  explicit Photographs(const geometry::Camera& camera);

  /// \param margin  the board's white border, in squares. \param around  the grey beside it.
  [[nodiscard]] cv::Mat of(const geometry::Pose& X_CB, const Board& board, std::mt19937& random, double margin = 0.7,
                           double around = 110.0) const;

 private:
  int width_px_;
  int height_px_;
  std::vector<Eigen::Vector2d> rays_;  // nine of each pixel, (x, y, 1) in the camera's frame
};

}  // namespace cgsr::calibration::testing
