#include "pipeline/render/reproject.h"

#include <cmath>

#include "pipeline/render/clip.h"
#include "pipeline/render/view.h"

namespace cgsr::render {
bool look_again(const geometry::Pose& drawn, const geometry::Pose& now, const KeepParameters& parameters) {
  constexpr double kDegree = 0.017453292519943295;
  const double cosine = 0.5 * ((drawn.linear().transpose() * now.linear()).trace() - 1.0);
  return (now.translation() - drawn.translation()).norm() > parameters.moved_m ||
         cosine < std::cos(parameters.turned_deg * kDegree);
}

void reproject(const world::Map& map, const geometry::Pose& X_WC, const geometry::Camera& camera,
               std::span<const VisiblePiece> known, std::vector<VisiblePiece>& pieces, double near_m) {
  pieces.clear();
  const View view = view_of(camera, camera.width_px, camera.height_px);
  const Eigen::Matrix3d R_CW = X_WC.linear().transpose();
  for (const VisiblePiece& piece : known) {
    if (pieces.size() == pieces.capacity()) return;
    const world::Edge& edge = map.edges[piece.edge];
    const Eigen::Vector3d p_WA = map.vertices[edge.vertices[0]].cast<double>();
    const Eigen::Vector3d along_W = map.vertices[edge.vertices[1]].cast<double>() - p_WA;
    const Eigen::Vector3d p_CA = R_CW * (p_WA - X_WC.translation());
    const Eigen::Vector3d along_C = R_CW * along_W;
    double t0 = piece.from;
    double t1 = piece.to;
    // All five borders are planes through (or parallel to) the camera: linear along the edge itself.
    const auto inside = [&](double nx, double ny, double nz, double offset) {
      return clip(nx * p_CA.x() + ny * p_CA.y() + nz * p_CA.z() + offset,
                  nx * along_C.x() + ny * along_C.y() + nz * along_C.z(), t0, t1);
    };
    if (!inside(0.0, 0.0, 1.0, -near_m) || !inside(camera.fx_px, 0.0, camera.cx_px - view.left_px, 0.0) ||
        !inside(-camera.fx_px, 0.0, view.right_px - camera.cx_px, 0.0) ||
        !inside(0.0, camera.fy_px, camera.cy_px - view.top_px, 0.0) ||
        !inside(0.0, -camera.fy_px, view.bottom_px - camera.cy_px, 0.0)) {
      continue;
    }
    const auto pixel = [&](double t) {
      const Eigen::Vector3d p = p_CA + t * along_C;
      return Eigen::Vector2d(camera.fx_px * p.x() / p.z() + camera.cx_px, camera.fy_px * p.y() / p.z() + camera.cy_px)
          .cast<float>()
          .eval();
    };
    pieces.push_back({piece.edge, static_cast<float>(t0), static_cast<float>(t1), pixel(t0), pixel(t1)});
  }
}

}  // namespace cgsr::render
