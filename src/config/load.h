#pragma once

#include <filesystem>

#include "platform/error.h"
#include "src/config/color.h"
#include "src/config/light.h"
#include "src/config/localization.h"
#include "src/config/robot.h"

// Every command reads the same kind of file: a robot's file, or one that has only the sections that the command needs.

namespace cgsr::config {

/// \return what a robot's file and the files that it extends say, with paths as the program can open them; or every problem, a line each.
Result<Robot> load_robot(const std::filesystem::path& file);

/// The same without asking whether the sections make a robot that can run: for a command that needs only some of them.
Result<Robot> load_sections(const std::filesystem::path& file);

/// \return the section [color], or its defaults when `file` is empty; or every problem of the file.
Result<Color> load_color(const std::filesystem::path& file);

/// \return the section [localization], or six_free_numbers() when `file` is empty; or every problem of the file.
Result<Localization> load_localization(const std::filesystem::path& file);

/// \return the sections [mount], [probes] and [lamp]; or every problem of the file.
Result<Light> load_light(const std::filesystem::path& file);

}  // namespace cgsr::config
