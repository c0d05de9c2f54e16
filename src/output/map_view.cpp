#include "src/output/map_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace cgsr::app {
namespace {

constexpr int kShift = 4;  // OpenCV draws with so many bits below the pixel.

cv::Scalar color_of(world::EdgeKind kind) {
  switch (kind) {
    case world::EdgeKind::kCrease:
      return {60, 220, 60};
    case world::EdgeKind::kBorder:
      return {40, 160, 255};
    case world::EdgeKind::kMaterial:
      return {255, 120, 40};
    case world::EdgeKind::kDrawn:
      return {230, 60, 230};
  }
  return {};
}

cv::Vec3b shade(const world::Map& map, const world::Hit& hit, const Eigen::Vector3d& direction) {
  const world::Surface& surface = map.surfaces[hit.surface];
  const float facing = std::abs(surface.normal.dot(direction.cast<float>()));
  const Eigen::Vector3f color = (255.0F * (0.6F + 0.4F * facing)) * map.materials[surface.material].color;
  return {cv::saturate_cast<std::uint8_t>(color.z()), cv::saturate_cast<std::uint8_t>(color.y()),
          cv::saturate_cast<std::uint8_t>(color.x())};
}

}  // namespace

cv::Mat draw_surfaces(const world::Map& map, const world::Index& index, const geometry::Pose& X_WC,
                      const geometry::Camera& camera) {
  cv::Mat picture(camera.height_px, camera.width_px, CV_8UC3, cv::Scalar(32, 24, 24));
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const Eigen::Vector3d direction = X_WC.linear() * camera.ideal_of({u, v}).homogeneous().normalized();
      const auto hit = index.first_hit(X_WC.translation().cast<float>(), direction.cast<float>(), 1e6F);
      if (hit) picture.at<cv::Vec3b>(v, u) = shade(map, *hit, direction);
    }
  }
  return picture;
}

void draw_pieces(const world::Map& map, std::span<const render::VisiblePiece> pieces, const geometry::Camera& camera,
                 cv::Mat& picture) {
  const auto at_lens = [&](const Eigen::Vector2d& pixel) {
    const Eigen::Vector2d bent =
        camera.distorted({(pixel.x() - camera.cx_px) / camera.fx_px, (pixel.y() - camera.cy_px) / camera.fy_px});
    constexpr double kScale = 1 << kShift;
    return cv::Point(static_cast<int>(std::lround(kScale * (camera.fx_px * bent.x() + camera.cx_px))),
                     static_cast<int>(std::lround(kScale * (camera.fy_px * bent.y() + camera.cy_px))));
  };
  for (const render::VisiblePiece& piece : pieces) {
    const Eigen::Vector2d from = piece.p0.cast<double>();
    const Eigen::Vector2d to = piece.p1.cast<double>();
    const int steps = camera.has_distortion() ? 1 + static_cast<int>((to - from).norm() / 20.0) : 1;
    for (int i = 0; i < steps; ++i) {
      const auto place = [&](int k) { return at_lens(from + (to - from) * (static_cast<double>(k) / steps)); };
      cv::line(picture, place(i), place(i + 1), color_of(map.edges[piece.edge].kind), 1, cv::LINE_AA, kShift);
    }
  }
}

}  // namespace cgsr::app
