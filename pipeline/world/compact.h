#pragma once

#include <filesystem>

#include "pipeline/world/map.h"
#include "platform/error.h"

namespace cgsr::world {

/// A map with its edges, cleaned up, as one block of numbers: "CGSRMAP" and a version, the counts, SHA-256 of what follows, then vertices, triangles,
/// surfaces, edges and materials, little-endian. Ours.
inline constexpr const char* kCompactExtension = ".cgsrmap";

/// Writes it beside `path`, as NAME.part, and renames it there: nobody reads half of it, and where it cannot be written what was there remains.
Result<void> write_compact(const Map& map, const std::filesystem::path& path);

/// Errors: another file, another version, cut short or longer than it says, a checksum that does not fit, indices beyond what they point into,
/// numbers that are not finite.
Result<Map> read_compact(const std::filesystem::path& path);

}  // namespace cgsr::world
