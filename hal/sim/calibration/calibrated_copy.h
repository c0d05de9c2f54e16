#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "hal/sim/scene/camera_model.h"
#include "hal/sim/scene/scene.h"
#include "platform/parameters.h"

namespace cgsr::sim {

/// How well camera, mount, probes and map were measured: standard deviations. All zero: the truth itself.
struct CalibrationErrors {
  double focal = 0.001;          ///< of fx and fy, relative, each by itself.
  double centre_px = 0.5;        ///< of cx and cy.
  double distortion = 0.02;      ///< of each coefficient, relative.
  double mount_m = 0.003;        ///< of each coordinate of the camera on the robot.
  double mount_deg = 0.2;        ///< about each axis.
  double probe_m = 0.001;        ///< of each coordinate of an apex and of the board's height.
  double map_scale = 0.001;      ///< of the whole map along x, y and z: a tape measure's.
  double map_place_m = 0.005;    ///< of a piece of furniture, along the floor.
  double map_heading_deg = 0.2;  ///< of a piece of furniture.
  double map_part_m = 0.0;       ///< of every rigid part, walls too, along each axis that what it touches leaves free.
  double map_color = 0.02;       ///< of each channel of a material, sRGB-encoded.

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("focal", self.focal, {0.0, 0.1}, "", "of fx and fy, relative");
    visit.number("centre_px", self.centre_px, {0.0, 50.0}, "px", "of cx and cy");
    visit.number("distortion", self.distortion, {0.0, 1.0}, "", "of each coefficient, relative");
    visit.number("mount_m", self.mount_m, {0.0, 0.5}, "m", "of the camera's place on the robot, each coordinate");
    visit.number("mount_deg", self.mount_deg, {0.0, 20.0}, "deg", "of the camera's direction, about each axis");
    visit.number("probe_m", self.probe_m, {0.0, 0.1}, "m", "of an apex and of the board's height, each coordinate");
    visit.number("map_scale", self.map_scale, {0.0, 0.1}, "", "of the whole map along x, y and z, relative");
    visit.number("map_place_m", self.map_place_m, {0.0, 1.0}, "m", "of a piece of furniture, along the floor");
    visit.number("map_heading_deg", self.map_heading_deg, {0.0, 20.0}, "deg", "of a piece of furniture");
    visit.number("map_part_m", self.map_part_m, {0.0, 1.0}, "m", "of every rigid part, each coordinate");
    visit.number("map_color", self.map_color, {0.0, 0.5}, "", "of each channel of a material, sRGB-encoded");
  }

  /// What chapter 4 is measured with: intrinsics 0.2 % and 0.5 px, mount 0.3 degrees about each axis, map 0.5 cm per rigid part.
  static CalibrationErrors chapter_4();
  /// None: the copy is the truth.
  static CalibrationErrors none();

  /// Every error so many times as large.
  [[nodiscard]] CalibrationErrors times(double factor) const;
};

/// A probe as the robot's configuration states it, in the robot's frame.
struct MeasuredProbe {
  Eigen::Vector3d p_RA = Eigen::Vector3d::Zero();  ///< apex.
  Eigen::Vector3d p_RF = Eigen::Vector3d::Zero();  ///< middle of its base on the board.
  double base_radius_m = 0.0;
};

/// The board's upper face, level in the robot's frame.
struct MeasuredBoard {
  Eigen::Vector3d p_RB = Eigen::Vector3d::Zero();
  double width_m = 0.0;
  double depth_m = 0.0;
  std::vector<MeasuredProbe> probes;
};

/// All that the vision is ever told about a simulated robot and its home.
struct CalibratedCopy {
  std::string robot;
  CameraModel camera;
  Pose X_RC = Pose::Identity();
  bool has_board = false;
  MeasuredBoard board;
  Scene map;  ///< static parts that are `in_map` and their materials; no lamps, nobody.
};

/// Measures the robot and its home, with errors drawn from `seed`: the same seed, the same copy, on every machine.
///
/// The map is stretched as a whole. Furniture (whatever is named alike, up to the '/', and is no longer than 2.5 m) is also misplaced on its
/// own: along the floor and about the vertical; flat things along themselves only, so that a poster stays before its wall and tape on its
/// floor. `map_part_m` moves everything, however long: what stands on the floor along the floor, what lies on something along itself and
/// with it, all else along every axis.
CalibratedCopy calibrated_copy(const Scene& scene, int robot, const CalibrationErrors& errors, std::uint32_t seed);

}  // namespace cgsr::sim
