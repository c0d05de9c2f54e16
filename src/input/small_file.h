#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "platform/error.h"

namespace cgsr::app {

/// Reads a whole file that a person or a small tool wrote, a byte order mark taken off.
///
/// \param what  for the message: "a camera file".
/// \return its text; or why not: not there, a folder, unreadable, larger than `most_bytes` (also an endless device).
Result<std::string> read_small_file(const std::filesystem::path& file, std::size_t most_bytes, std::string_view what);

}  // namespace cgsr::app
