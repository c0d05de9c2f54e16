#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "pipeline/geometry/pose.h"
#include "platform/error.h"

namespace cgsr::app {

/// Reads where the camera is on the robot: the section [mount] of the file `robot.toml` that `cgsr sim export` and `cgsr calibrate mount`
/// write, `position_m` (three numbers) and `quaternion_wxyz` (four, of length 1 to a thousandth). Its other sections belong to others.
///
/// \return X_RC; or what is wrong, with file, line, value and what was expected.
Result<geometry::Pose> read_mount(const std::filesystem::path& file);

/// A probe as robot.toml states it: metres, robot's frame.
struct CalibratedProbe {
  std::array<double, 3> apex_m{};
  std::array<double, 3> foot_m{};
  double base_radius_m = 0.0;
};

/// The probe board as robot.toml states it, robot's frame.
struct CalibratedBoard {
  std::array<double, 3> position_m{};
  std::array<double, 3> turn_deg{};
  double width_m = 0.0;
  double depth_m = 0.0;
  std::vector<CalibratedProbe> probe;  ///< one or two, the left one first.
};

/// Reads the section [board] with its [[board.probe]] of the same file, as `cgsr sim export` and `cgsr calibrate probes` write it; `turn_deg` may be
/// missing.
///
/// \return nothing where the file has no such section; or what is wrong, with file, line, value and what was expected.
Result<std::optional<CalibratedBoard>> read_board(const std::filesystem::path& file);

}  // namespace cgsr::app
