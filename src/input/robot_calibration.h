#pragma once

#include <filesystem>

#include "pipeline/geometry/pose.h"
#include "platform/error.h"

namespace cgsr::app {

/// Reads where the camera is on the robot: the section [mount] of the file `robot.toml` that `cgsr sim export` and `cgsr calibrate mount`
/// write, `position_m` (three numbers) and `quaternion_wxyz` (four, of length 1 to a thousandth). Its other sections belong to others.
///
/// \return X_RC; or what is wrong, with file, line, value and what was expected.
Result<geometry::Pose> read_mount(const std::filesystem::path& file);

}  // namespace cgsr::app
