#pragma once

#include <filesystem>

#include "platform/error.h"
#include "src/config/color.h"

namespace cgsr::config {

/// \return the section [color] of a robot's file, or the shipped defaults when `file` is empty; or every problem of the file.
Result<Color> load_color(const std::filesystem::path& file);

}  // namespace cgsr::config
