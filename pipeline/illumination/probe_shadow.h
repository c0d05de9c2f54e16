#pragma once

#include <array>

#include <Eigen/Core>

#include "platform/parameters.h"

namespace cgsr::illumination {

/// What counts as a shadow of a probe: section [probes.shadow] of a robot's file (Alg. 5.1).
struct ShadowParameters {
  double lamp_radius_m = 0.05;
  double lamp_radius_sigma_m = 0.05;
  double min_contrast = 2.0;
  double min_contrast_ratio = 0.015;
  double min_support = 0.7;
  double max_angle_deg = 76.0;
  double spacing_px = 5.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("lamp_radius_m", self.lamp_radius_m, {0.0, 1.0}, "m",
                 "The radius of a lamp from which the estimate of each shadow's softness starts.");
    visit.number("lamp_radius_sigma_m", self.lamp_radius_sigma_m, {1e-4, 1.0}, "m",
                 "The standard deviation of that radius; a small value fixes it.");
    visit.number("min_contrast", self.min_contrast, {0.5, 100.0}, "grey levels",
                 "The smallest contrast between board and shadow.");
    visit.number("min_contrast_ratio", self.min_contrast_ratio, {0.0, 1.0}, "",
                 "The smallest contrast between board and shadow, as a ratio of the board's brightness.");
    visit.number("min_support", self.min_support, {0.0, 1.0}, "",
                 "The smallest share of the samples along a line that must show the shadow's contrast.");
    visit.number("max_angle_deg", self.max_angle_deg, {30.0, 88.0}, "deg",
                 "The largest angle between the light and the vertical at which shadows are searched for.");
    visit.number("spacing_px", self.spacing_px, {1.0, 50.0}, "px", "The distance between the samples along a line.");
  }
};

/// The shadow of one probe's tip on the board's plane (the apex shadow of 5.1), found by the outline of the whole shadow. Board's frame,
/// metres and square metres.
struct ProbeShadow {
  Eigen::Vector2d p_BS = Eigen::Vector2d::Zero();
  /// Of what this image's noise and the base's place do to p_BS. With one line only it is large along that line.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  /// d p_BS / d step of the camera (geometry::moved(X_BC, step)): the same camera saw the other probe.
  Eigen::Matrix<double, 2, 6> J_pose = Eigen::Matrix<double, 2, 6>::Zero();
  int lines = 0;  ///< 2: the tip is known; 1: the plane through lamp, tip and this line.
  std::array<bool, 2> line_seen{};
  double contrast = 0.0;       ///< grey levels.
  double seen_contrast = 0.0;  ///< of it, what the image shows: less where the board is clipped.
  double level = 0.0;          ///< of the board beside it: more than the image holds where the board is clipped.
  double support = 0.0;        ///< share of places along the lines that show it.
  double rms = 0.0;            ///< grey levels that the model does not explain.
  /// Of the lamp, as soft as the shadow's edges are; and its standard deviation.
  double lamp_radius_m = 0.0;
  double lamp_radius_sigma_m = 0.0;
};

}  // namespace cgsr::illumination
