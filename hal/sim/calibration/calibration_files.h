#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "hal/sim/calibration/calibrated_copy.h"
#include "platform/error.h"

namespace cgsr::sim {

/// A camera file as ROS's camera_calibration writes it: image_width, image_height, camera_name, camera_matrix, distortion_model (plumb_bob),
/// distortion_coefficients (k1 k2 p1 p2 k3), rectification_matrix, projection_matrix.
std::string camera_as_yaml(const CameraModel& camera, const std::string& name);

/// The camera's mount and the probe board in the robot's frame, as TOML: [mount] with position_m and quaternion_wxyz, [board] with [[board.probe]],
/// and [sigma], the errors that were stated.
std::string robot_as_toml(const CalibratedCopy& copy, const CalibrationErrors& errors);

/// Writes camera.yaml, robot.toml, map.obj and map.mtl into `folder`, which is made.
Result<void> write_calibration(const CalibratedCopy& copy, const CalibrationErrors& errors, std::uint32_t seed,
                               const std::filesystem::path& folder);

}  // namespace cgsr::sim
