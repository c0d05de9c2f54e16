#include "tests/calibration/board_pictures.h"

#include <cstdint>

namespace cgsr::calibration::testing {
namespace {

constexpr int kSide = 3;  // samples of a pixel across and down
constexpr int kSamples = kSide * kSide;

}  // namespace

Photographs::Photographs(const geometry::Camera& camera) : width_px_(camera.width_px), height_px_(camera.height_px) {
  rays_.reserve(static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_) * kSamples);
  for (int y = 0; y < height_px_; ++y) {
    for (int x = 0; x < width_px_; ++x) {
      for (int k = 0; k < kSamples; ++k) {
        const int row = k / kSide;
        rays_.push_back(camera.ideal_of({x + (k % kSide - 1) / 3.0, y + (row - 1) / 3.0}));
      }
    }
  }
}

cv::Mat Photographs::of(const geometry::Pose& X_CB, const Board& board, std::mt19937& random, double margin,
                        double around) const {
  cv::Mat picture(height_px_, width_px_, CV_8U);
  const geometry::Pose X_BC = X_CB.inverse();
  auto next = rays_.begin();
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      double sum = 0.0;
      for (int k = 0; k < kSamples; ++k, ++next) {
        const Eigen::Vector3d ray = X_BC.linear() * Eigen::Vector3d(next->x(), next->y(), 1.0);
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
      picture.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(sum / kSamples + normal(random));
    }
  }
  return picture;
}

}  // namespace cgsr::calibration::testing
