#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "platform/parameters.h"

namespace cgsr::calibration {

/// An ArUco marker on a wall whose place is known.
struct Marker {
  int id = -1;
  double side_m = 0.15;
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 1.0;
  double facing_deg = 0.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("id", self.id, {-1, 49}, "",
                 "The number of the marker among the 4x4 markers (OpenCV's DICT_4X4_50); -1 means none.");
    visit.number("side_m", self.side_m, {0.01, 2.0}, "m", "The side of the marker's black square.");
    visit.number("x_m", self.x_m, {-10000.0, 10000.0}, "m", "The x coordinate of the marker's centre in the world.");
    visit.number("y_m", self.y_m, {-10000.0, 10000.0}, "m", "The y coordinate of the marker's centre in the world.");
    visit.number("z_m", self.z_m, {-100.0, 100.0}, "m", "The height of the marker's centre above the floor.");
    visit.number("facing_deg", self.facing_deg, {-360.0, 360.0}, "deg",
                 "The direction of the marker's normal, from the world's x axis.");
  }
};

/// \param image  grey or BGR, of the camera's size.
/// \return X_WC as a marker of known size and place shows it (ArUco, Garrido-Jurado et al. 2014; 4x4, of OpenCV's DICT_4X4_50); nothing when it is not seen,
/// is seen twice, or is so small or so oblique that its pose is not certain.
std::optional<geometry::Pose> camera_by_marker(const Marker& marker, const geometry::Camera& camera,
                                               const cv::Mat& image);

}  // namespace cgsr::calibration
