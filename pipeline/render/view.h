#pragma once

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"

namespace cgsr::render {

/// A rectangle of pixels of a camera without lens, the view plane (2.2), and a raster laid over it.
///
/// A lens may show more than a pinhole of the same focal lengths does at the same image size: the rectangle is the box around all that the lens
/// shows. Without lens it is the image itself.
struct View {
  double left_px = -0.5;  ///< pixels of the camera without lens.
  double top_px = -0.5;
  double right_px = 639.5;
  double bottom_px = 479.5;
  int width = 320;  ///< of the raster.
  int height = 240;
  double fx = 300.9;  ///< pinhole of the raster: u = fx X/Z + cx, 0 at the centre of its top-left cell.
  double fy = 289.7;
  double cx = 159.5;
  double cy = 119.5;

  [[nodiscard]] double cells_per_px_x() const { return width / (right_px - left_px); }
  [[nodiscard]] double cells_per_px_y() const { return height / (bottom_px - top_px); }
};

/// \param width, height  cells of the raster, > 0.  Cost: without lens next to nothing, with one about 0.02 Minstr.
View view_of(const geometry::Camera& camera, int width, int height);

/// Keeps the view of the last camera, so that a camera that stays costs nothing.
class ViewKeeper {
 public:
  ViewKeeper(int width, int height) : view_(view_of(camera_, width, height)) {}

  const View& of(const geometry::Camera& camera);

 private:
  geometry::Camera camera_;
  View view_;
};

}  // namespace cgsr::render
