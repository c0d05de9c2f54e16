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

namespace {

/// Whether a triangle of the map stands before a place on an edge. \param edge  whose own surfaces do not count.
bool is_hidden(const world::Map& map, const world::Edge& edge, const Vector3d& p_WC, const Vector3d& p) {
  constexpr double kBefore = 0.995;  // of the way to the place
  const Vector3d ray = p - p_WC;
  for (std::uint32_t s = 0; s < map.surfaces.size(); ++s) {
    const world::Surface& surface = map.surfaces[s];
    if (s == edge.surfaces[0] || s == edge.surfaces[1] || !is_seen_from(surface, p_WC.cast<float>())) continue;
    for (std::uint32_t t = surface.first_triangle; t < surface.first_triangle + surface.triangle_count; ++t) {
      const Vector3d a = map.vertices[map.triangles[t][0]].cast<double>();
      const Vector3d e1 = map.vertices[map.triangles[t][1]].cast<double>() - a;
      const Vector3d e2 = map.vertices[map.triangles[t][2]].cast<double>() - a;
      const Vector3d across = ray.cross(e2);
      const double det = e1.dot(across);
      if (det == 0.0) continue;
      const Vector3d from_a = p_WC - a;
      const double u = from_a.dot(across) / det;
      const Vector3d q = from_a.cross(e1);
      const double v = ray.dot(q) / det;
      const double at = e2.dot(q) / det;
      if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && at > 0.0 && at < kBefore) return true;
    }
  }
  return false;
}

}  // namespace

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
  const geometry::Pose X_CW = X_WC.inverse();
  const Vector3d p_WC = X_WC.translation();
  std::vector<double> found;
  for (const world::Edge& edge : map.edges) {
    if (!is_seen_from(map, edge, p_WC.cast<float>())) continue;
    const Vector3d from = X_CW * map.vertices[edge.vertices[0]].cast<double>();
    const Vector3d to = X_CW * map.vertices[edge.vertices[1]].cast<double>();
    const auto a = camera.pixel_of(from);
    const auto b = camera.pixel_of(to);
    if (!a || !b || (*b - *a).norm() < kStep_px) continue;
    const Vector2d along = (*b - *a).normalized();
    const Vector2d normal(-along.y(), along.x());
    const int steps = static_cast<int>((*b - *a).norm() / kStep_px);
    for (int i = 0; i <= steps; ++i) {
      const Vector2d p = *a + along * (kStep_px * i);
      if (p.x() < 3 || p.y() < 3 || p.x() > grey.cols - 4 || p.y() > grey.rows - 4) continue;
      const double share = kStep_px * i / (*b - *a).norm();
      const double along_edge =
          share * from.z() / (to.z() + share * (from.z() - to.z()));  // 1/Z is linear in the image
      if (is_hidden(map, edge, p_WC, X_WC * (from + along_edge * (to - from)))) continue;
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
