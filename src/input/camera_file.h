#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pipeline/geometry/camera.h"
#include "platform/error.h"

namespace cgsr::app {

/// Reads the intrinsics of a camera as ROS's camera_calibration writes them: image_width, image_height, camera_matrix, distortion_model
/// (plumb_bob), distortion_coefficients (k1 k2 p1 p2, and k3 or not). Other keys are passed by.
///
/// \return the camera; or the first thing that is wrong, with file, line, value and what was expected: what is no YAML, missing or doubled
///         keys, numbers that are not finite, another distortion model, skew, an optical axis outside of the image, focal lengths of no
///         lens, a distortion that folds the image over itself.
Result<geometry::Camera> read_camera(const std::filesystem::path& file);

/// The same from text; `name` is what messages call it.
Result<geometry::Camera> parse_camera(const std::string& text, std::string_view name);

/// The file that read_camera() and ROS read; numbers read back exactly.
/// \param name  the camera's, letters, digits and underscores.
std::string camera_as_yaml(const geometry::Camera& camera, std::string_view name);

}  // namespace cgsr::app
