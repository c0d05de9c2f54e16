#include "tools/lab/localization/canny_judge.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

namespace cgsr::lab {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d centre_of(const world::Map& map) {
  Vector3d low = Vector3d::Constant(1e9);
  Vector3d high = -low;
  for (const Eigen::Vector3f& p : map.vertices) {
    low = low.cwiseMin(p.cast<double>());
    high = high.cwiseMax(p.cast<double>());
  }
  return (low + high) / 2.0;
}

std::vector<double> distances_to_canny(const cv::Mat& grey, const world::Map& map, const geometry::Camera& camera,
                                       const geometry::Pose& X_WC) {
  constexpr double kStep_px = 5.0;
  constexpr int kFarthest_px = 20;
  const double min_cosine = std::cos(20.0 * std::numbers::pi / 180.0);
  cv::Mat smooth;
  cv::Mat edges;
  cv::Mat dx;
  cv::Mat dy;
  cv::GaussianBlur(grey, smooth, {5, 5}, 1.0);
  cv::Sobel(smooth, dx, CV_32F, 1, 0);
  cv::Sobel(smooth, dy, CV_32F, 0, 1);
  cv::Canny(smooth, edges, 20, 60);
  const Vector3d centre = centre_of(map);
  const geometry::Pose X_CW = X_WC.inverse();
  const auto faces = [&](std::uint32_t s) {
    if (s == world::kNone) return false;
    const world::Surface& surface = map.surfaces[s];
    const Vector3d n = surface.normal.cast<double>();
    const double outward = n.dot(centre) < static_cast<double>(surface.offset_m) ? 1.0 : -1.0;
    return outward * (n.dot(X_WC.translation()) - static_cast<double>(surface.offset_m)) > 0.0;
  };
  std::vector<double> found;
  for (const world::Edge& edge : map.edges) {
    if (!faces(edge.surfaces[0]) && !faces(edge.surfaces[1])) continue;
    const auto a = camera.pixel_of(X_CW * map.vertices[edge.vertices[0]].cast<double>());
    const auto b = camera.pixel_of(X_CW * map.vertices[edge.vertices[1]].cast<double>());
    if (!a || !b || (*b - *a).norm() < kStep_px) continue;
    const Vector2d along = (*b - *a).normalized();
    const Vector2d normal(-along.y(), along.x());
    const int steps = static_cast<int>((*b - *a).norm() / kStep_px);
    for (int i = 0; i <= steps; ++i) {
      const Vector2d p = *a + along * (kStep_px * i);
      if (p.x() < 3 || p.y() < 3 || p.x() > grey.cols - 4 || p.y() > grey.rows - 4) continue;
      double nearest = kFarthest_px;
      for (int y = static_cast<int>(p.y()) - kFarthest_px; y <= static_cast<int>(p.y()) + kFarthest_px; ++y) {
        for (int x = static_cast<int>(p.x()) - kFarthest_px; x <= static_cast<int>(p.x()) + kFarthest_px; ++x) {
          if (x < 0 || y < 0 || x >= grey.cols || y >= grey.rows || edges.at<std::uint8_t>(y, x) == 0) continue;
          const Vector2d gradient(dx.at<float>(y, x), dy.at<float>(y, x));
          if (std::abs(gradient.normalized().dot(normal)) < min_cosine) continue;
          nearest = std::min(nearest, (Vector2d(x, y) - p).norm());
        }
      }
      found.push_back(nearest);
    }
  }
  return found;
}

void CannyTally::add(std::vector<double> distances_px) {
  constexpr double kMedian_px = 2.0;
  constexpr double kNear_px = 3.0;
  constexpr double kShare = 0.8;
  if (distances_px.empty()) return;
  std::ranges::sort(distances_px);
  medians.push_back(distances_px[distances_px.size() / 2]);
  const auto within = std::ranges::count_if(distances_px, [&](double px) { return px <= kNear_px; });
  const auto all = static_cast<double>(distances_px.size());
  followed += medians.back() <= kMedian_px && static_cast<double>(within) >= kShare * all ? 1 : 0;
  near += static_cast<int>(within);
  places += static_cast<int>(distances_px.size());
}

}  // namespace cgsr::lab
