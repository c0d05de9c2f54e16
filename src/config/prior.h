#pragma once

#include "pipeline/localization/correction.h"
#include "platform/parameters.h"

namespace cgsr::config {

/// How well the camera's pose is known before an image is looked at: standard deviations.
struct PriorParameters {
  double x_m = 0.15;
  double y_m = 0.15;
  double z_m = 0.15;
  double heading_deg = 4.0;
  double tilt_deg = 1.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("x_m", self.x_m, {1e-4, 10.0}, "m",
                 "The standard deviation of the position along the world's x axis.");
    visit.number("y_m", self.y_m, {1e-4, 10.0}, "m",
                 "The standard deviation of the position along the world's y axis.");
    visit.number("z_m", self.z_m, {1e-4, 10.0}, "m",
                 "The standard deviation of the height; it is small for a robot on a floor.");
    visit.number("heading_deg", self.heading_deg, {0.01, 90.0}, "deg",
                 "The standard deviation of the rotation about the vertical.");
    visit.number("tilt_deg", self.tilt_deg, {0.01, 90.0}, "deg",
                 "The standard deviation of the rotation about each horizontal axis.");
  }

  [[nodiscard]] localization::PriorSigmas sigmas() const {
    constexpr double kRad = 3.14159265358979323846 / 180.0;
    return {x_m, y_m, z_m, heading_deg * kRad, tilt_deg * kRad};
  }
};

}  // namespace cgsr::config
