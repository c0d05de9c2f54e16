#pragma once

#include <optional>

#include <Eigen/Core>

namespace cgsr::geometry {

/// Pinhole with Brown's distortion (Brown 1966), the terms and order of OpenCV's k1 k2 p1 p2 k3:
///   x = X/Z, y = Y/Z, r2 = x^2 + y^2, radial = 1 + k1 r2 + k2 r2^2 + k3 r2^3
///   x' = x radial + 2 p1 x y + p2 (r2 + 2 x^2),  y' = y radial + p1 (r2 + 2 y^2) + 2 p2 x y
///   u = fx x' + cx,  v = fy y' + cy
/// Pixels count from 0 at the centre of the top-left one. 'Ideal' coordinates are (x, y), without lens and without pixels.
struct Camera {
  int width_px = 640;
  int height_px = 480;
  double fx_px = 601.8;
  double fy_px = 579.4;
  double cx_px = 319.5;
  double cy_px = 239.5;
  double k1 = 0.0;
  double k2 = 0.0;
  double p1 = 0.0;
  double p2 = 0.0;
  double k3 = 0.0;

  [[nodiscard]] bool has_distortion() const { return k1 != 0.0 || k2 != 0.0 || p1 != 0.0 || p2 != 0.0 || k3 != 0.0; }

  /// Through the lens: ideal coordinates to (x', y').
  [[nodiscard]] Eigen::Vector2d distorted(const Eigen::Vector2d& ideal) const;

  /// A point in the camera's frame to its pixel; nothing for what is not in front (z <= 1e-6 m).
  [[nodiscard]] std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& p_C) const;

  /// A pixel to its ideal coordinates, by Newton's iteration. Exact to 1e-9 wherever the lens model is invertible; far outside of the image it
  /// may not be, then the last iterate comes back.
  [[nodiscard]] Eigen::Vector2d ideal_of(const Eigen::Vector2d& pixel) const;

  /// The pixel that a pinhole of the same focal lengths and centre would show: the lens taken out.
  [[nodiscard]] Eigen::Vector2d undistorted(const Eigen::Vector2d& pixel) const;

  /// The same view in fewer or more pixels.
  [[nodiscard]] Camera scaled_to(int width, int height) const;

  /// The same without lens.
  [[nodiscard]] Camera without_distortion() const;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("width_px", self.width_px, {16, 8192}, "px", "of the images that it was calibrated with");
    visit.number("height_px", self.height_px, {16, 8192}, "px", "likewise");
    visit.number("fx_px", self.fx_px, {10.0, 20000.0}, "px", "focal length along x");
    visit.number("fy_px", self.fy_px, {10.0, 20000.0}, "px", "focal length along y");
    visit.number("cx_px", self.cx_px, {-10000.0, 20000.0}, "px", "column of the optical axis");
    visit.number("cy_px", self.cy_px, {-10000.0, 20000.0}, "px", "row of the optical axis");
    visit.number("k1", self.k1, {-10.0, 10.0}, "", "radial distortion, as OpenCV counts it");
    visit.number("k2", self.k2, {-100.0, 100.0}, "", "radial distortion");
    visit.number("p1", self.p1, {-1.0, 1.0}, "", "tangential distortion");
    visit.number("p2", self.p2, {-1.0, 1.0}, "", "tangential distortion");
    visit.number("k3", self.k3, {-1000.0, 1000.0}, "", "radial distortion");
  }
};

}  // namespace cgsr::geometry
