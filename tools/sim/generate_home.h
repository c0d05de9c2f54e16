#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "hal/sim/generator/home.h"
#include "platform/error.h"

namespace cgsr::sim {

/// What `cgsr sim home` was asked for.
struct HomeRequest {
  std::uint32_t seed = 0;
  std::filesystem::path folder;
  bool force = false;  ///< files of a home that are there already are replaced; others stay.
};

/// Draws a home and writes its files. \return it; an error when the folder is a file, or is not empty without `force`.
Result<GeneratedHome> generate_home_to(const HomeRequest& request);

/// Is the folder not there yet, or empty? Else an error that says what to do.
Result<void> claim_folder(const std::filesystem::path& folder, bool force);

/// What was drawn, for the terminal.
std::string describe_home(const GeneratedHome& home);

}  // namespace cgsr::sim
