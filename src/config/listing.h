#pragma once

#include <string>
#include <string_view>

#include "src/config/robot.h"

namespace cgsr::config {

/// \return everything that takes effect as a TOML file with the same meaning, each value with the file and line that gives it, or `default`.
std::string show_text(const Robot& robot);

/// \return the keys in which two configurations differ, a line each with both values and where they come from, and their number. Paths of files are
///         compared as the program opens them.
std::string diff_text(const Robot& robot, const Robot& other);

/// \return the keys whose path contains `pattern`, or all for an empty one: default, unit, range and meaning. Empty when there is none.
std::string keys_text(std::string_view pattern);

}  // namespace cgsr::config
