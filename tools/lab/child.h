#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "platform/error.h"

namespace cgsr::lab {

/// \return a path in the folder for temporary files that no other process of the lab uses.
std::filesystem::path scratch_json();

/// Runs a program to its end and reads the JSON that it wrote.
///
/// \param words  the program and its arguments, which make it write `json`. The file is gone afterwards.
/// \return what it wrote; or its exit code and all that it printed.
Result<nlohmann::json> run_for_json(const std::vector<std::string>& words, const std::filesystem::path& json);

/// Runs a program to its end. \return what it printed, both outputs; or its exit code and that.
Result<std::string> run_for_text(const std::vector<std::string>& words);

}  // namespace cgsr::lab
