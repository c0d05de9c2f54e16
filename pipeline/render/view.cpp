#include "pipeline/render/view.h"

#include <algorithm>

namespace cgsr::render {

View view_of(const geometry::Camera& camera, int width, int height) {
  View view;
  view.left_px = -0.5;
  view.top_px = -0.5;
  view.right_px = camera.width_px - 0.5;
  view.bottom_px = camera.height_px - 0.5;
  if (camera.has_distortion()) {
    constexpr int kSteps = 4;  // along each side: enough for the bulge of a side
    Eigen::Array2d least(view.right_px, view.bottom_px);
    Eigen::Array2d most(view.left_px, view.top_px);
    const Eigen::Array2d corner(view.left_px, view.top_px);
    const Eigen::Array2d size(camera.width_px, camera.height_px);
    const auto take = [&](double x, double y) {
      const Eigen::Array2d pixel = camera.undistorted(corner + Eigen::Array2d(x, y) * size).array();
      least = least.min(pixel);
      most = most.max(pixel);
    };
    for (int i = 0; i <= kSteps; ++i) {
      const double at = static_cast<double>(i) / kSteps;
      take(at, 0.0);
      take(at, 1.0);
      take(0.0, at);
      take(1.0, at);
    }
    // A lens that cannot be inverted at the border must not make the view absurd.
    least = least.max(corner - 0.25 * size);
    most = most.min(corner + 1.25 * size);
    view.left_px = least.x();
    view.top_px = least.y();
    view.right_px = std::max(most.x(), least.x() + 1.0);
    view.bottom_px = std::max(most.y(), least.y() + 1.0);
  }
  view.width = width;
  view.height = height;
  view.fx = camera.fx_px * view.cells_per_px_x();
  view.fy = camera.fy_px * view.cells_per_px_y();
  view.cx = (camera.cx_px - view.left_px) * view.cells_per_px_x() - 0.5;
  view.cy = (camera.cy_px - view.top_px) * view.cells_per_px_y() - 0.5;
  return view;
}

const View& ViewKeeper::of(const geometry::Camera& camera) {
  const geometry::Camera& c = camera_;
  const bool same = c.width_px == camera.width_px && c.height_px == camera.height_px && c.fx_px == camera.fx_px &&
                    c.fy_px == camera.fy_px && c.cx_px == camera.cx_px && c.cy_px == camera.cy_px &&
                    c.k1 == camera.k1 && c.k2 == camera.k2 && c.p1 == camera.p1 && c.p2 == camera.p2 &&
                    c.k3 == camera.k3;
  if (!same) {
    camera_ = camera;
    view_ = view_of(camera, view_.width, view_.height);
  }
  return view_;
}

}  // namespace cgsr::render
