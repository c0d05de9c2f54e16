#pragma once

#include <filesystem>

#include "platform/error.h"
#include "src/config/robot.h"

namespace cgsr::config {

/// \return what a robot's file says, with its paths resolved; or every problem of the file, a line each.
Result<Robot> load_robot(const std::filesystem::path& file);

/// \return the section [color] of a robot's file, or the shipped defaults when `file` is empty; or every problem of the file.
Result<Color> load_color(const std::filesystem::path& file);

}  // namespace cgsr::config
