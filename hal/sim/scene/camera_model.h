#pragma once

namespace cgsr::sim {

/// Pinhole with Brown's distortion (the terms and order of OpenCV's k1 k2 p1 p2 k3):
///   r2 = x^2 + y^2,  radial = 1 + k1 r2 + k2 r2^2 + k3 r2^3
///   x' = x radial + 2 p1 x y + p2 (r2 + 2 x^2),  y' = y radial + p1 (r2 + 2 y^2) + 2 p2 x y
///   u = fx x' + cx,  v = fy y' + cy          pixels count from 0 at the centre of the top-left one
struct CameraModel {
  int width_px = 640;
  int height_px = 480;
  double fx_px = 601.8;
  double fy_px = 579.4;
  double cx_px = 319.5;
  double cy_px = 239.5;
  double k1 = -0.075;
  double k2 = 0.045;
  double p1 = 0.0006;
  double p2 = -0.0004;
  double k3 = 0.0;
  double rate_hz = 30.0;

  [[nodiscard]] CameraModel without_distortion() const {
    CameraModel plain = *this;
    plain.k1 = plain.k2 = plain.p1 = plain.p2 = plain.k3 = 0.0;
    return plain;
  }

  /// The same view in fewer or more pixels.
  [[nodiscard]] CameraModel scaled_to(int width, int height) const {
    CameraModel scaled = *this;
    const double sx = static_cast<double>(width) / width_px;
    const double sy = static_cast<double>(height) / height_px;
    scaled.width_px = width;
    scaled.height_px = height;
    scaled.fx_px *= sx;
    scaled.fy_px *= sy;
    scaled.cx_px = (cx_px + 0.5) * sx - 0.5;
    scaled.cy_px = (cy_px + 0.5) * sy - 0.5;
    return scaled;
  }
};

}  // namespace cgsr::sim
