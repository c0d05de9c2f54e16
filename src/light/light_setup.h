#pragma once

#include <array>
#include <string>

#include "pipeline/illumination/board.h"
#include "pipeline/illumination/lamp.h"
#include "pipeline/illumination/probe_observation.h"
#include "platform/error.h"
#include "src/input/image_input.h"

namespace cgsr::app {

/// The camera on the robot.
struct MountParameters {
  std::array<double, 3> position_m{0.0, 0.0, 1.2};
  double down_deg = 20.0;
  std::array<double, 3> turn_deg{0.0, 0.0, 0.0};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.numbers("position_m", self.position_m, {-5.0, 5.0}, "m", "of the optical centre, robot frame");
    visit.number("down_deg", self.down_deg, {-90.0, 90.0}, "deg", "how far a camera that looks forward is tilted down");
    visit.numbers("turn_deg", self.turn_deg, {-45.0, 45.0}, "deg",
                  "what calibration says it is turned beside that: a rotation vector, robot frame");
  }
  [[nodiscard]] geometry::Pose X_RC() const;
};

/// A file as config/illumination/lamp-robot.toml.
struct LightConfig {
  MountParameters mount;
  illumination::ProbesParameters probes;
  illumination::LampParameters lamp;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("mount", self.mount, "The camera on the robot");
    visit.section("probes", self.probes, "Board and probes, and how they are looked at (Alg. 5.1)");
    visit.section("lamp", self.lamp, "What is known of lamps, and how observations become one (Eq. 5.1, 5.2)");
  }
};

/// What every look at the probes needs.
struct LightSetup {
  LightConfig config;
  illumination::Board board;
  ImageInput input;
};

/// \param config_file  as config/illumination/lamp-robot.toml.  \param camera_file  intrinsics.  \param mount_file  a robot.toml with the mount and
///        perhaps the board, before what `config_file` says; empty: none.  \param images  video, image folder or image, of the camera's size.
Result<LightSetup> open_light_setup(const std::string& config_file, const std::string& camera_file,
                                    const std::string& mount_file, const std::string& images);

}  // namespace cgsr::app
