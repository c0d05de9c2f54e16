#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "platform/error.h"

namespace cgsr::world {

inline constexpr std::uintmax_t kLargestBytes = 512U << 20;

/// \return a whole file. Ours. Errors: what is not a file, cannot be read, or has more than kLargestBytes.
Result<std::string> read_text(const std::filesystem::path& path);

}  // namespace cgsr::world
