#pragma once

#include <array>
#include <string>

#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/lamp.h"
#include "pipeline/illumination/probe_observation.h"

namespace cgsr::config {

/// The pose of the camera on the robot, for commands that are given no file with a calibrated one.
struct Mount {
  std::array<double, 3> position_m{0.0, 0.0, 1.2};
  double down_deg = 20.0;
  std::array<double, 3> turn_deg{0.0, 0.0, 0.0};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.numbers("position_m", self.position_m, {-5.0, 5.0}, "m",
                  "The position of the camera's optical centre, in the robot's frame.");
    visit.number("down_deg", self.down_deg, {-90.0, 90.0}, "deg",
                 "The angle by which a camera that looks forward is tilted down.");
    visit.numbers("turn_deg", self.turn_deg, {-45.0, 45.0}, "deg",
                  "The additional rotation found by calibration, as a rotation vector in the robot's frame.");
  }

  /// \return the pose of the camera in the robot's frame.
  [[nodiscard]] geometry::Pose X_RC() const;
};

/// Chapter 5's own configuration (config/illumination/*.toml), whose hash the reports of `cgsr light` print.
struct Light {
  Mount mount;
  illumination::ProbesParameters probes;
  illumination::LampParameters lamp;
  std::string
      mount_file;  ///< localization.mount: a calibrated pose of the camera, used instead of `mount`; empty: none.

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("mount", self.mount, "The pose of the camera on the robot");
    visit.section("probes", self.probes, "The probe board and how it is observed (Alg. 5.1)");
    visit.section("lamp", self.lamp, "Prior knowledge of lamps, and the fusion of observations (Eq. 5.1, 5.2)");
  }
};

}  // namespace cgsr::config
