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

/// A grey image of the board. \param margin  its white border, in squares. \param around  the grey beside it.
inline cv::Mat picture_of(const geometry::Pose& X_CB, const Board& board, const geometry::Camera& camera,
                          std::mt19937& random, double margin = 0.7, double around = 110.0) {
  constexpr int kSamples = 3;
  cv::Mat picture(camera.height_px, camera.width_px, CV_8U);
  const geometry::Pose X_BC = X_CB.inverse();
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      double sum = 0.0;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const Eigen::Vector2d at(x + (k % kSamples - 1) / 3.0, y + (static_cast<int>(k / kSamples) - 1) / 3.0);
        const Eigen::Vector2d ideal = camera.ideal_of(at);
        const Eigen::Vector3d ray = X_BC.linear() * Eigen::Vector3d(ideal.x(), ideal.y(), 1.0);
        const double far = -X_BC.translation().z() / ray.z();
        const Eigen::Vector3d p = X_BC.translation() + far * ray;
        const double u = p.x() / board.square_m;
        const double v = p.y() / board.square_m;
        const bool on_paper = far > 0.0 && u > -1.0 - margin && v > -1.0 - margin && u < board.columns + margin &&
                              v < board.rows + margin;
        const bool on_squares = on_paper && u > -1.0 && v > -1.0 && u < board.columns && v < board.rows;
        const bool black = on_squares && (static_cast<int>(std::floor(u)) + static_cast<int>(std::floor(v))) % 2 == 0;
        sum += !on_paper ? around : black ? 45.0 : 200.0;
      }
      picture.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(sum / (kSamples * kSamples) + normal(random));
    }
  }
  return picture;
}

}  // namespace cgsr::calibration::testing
