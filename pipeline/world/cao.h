#pragma once

#include <filesystem>

#include "pipeline/world/soup.h"
#include "platform/error.h"

namespace cgsr::world {

/// Reads ViSP's model files (.cao, version 1): 3D points, 3D lines, faces from lines and from points, and other files that it loads, with their
/// `t=[x; y; z]` and `tu=[x; y; z]` (radians). A line's or face's options (name, useLod, ...) are read over. Refused by name: cylinders and
/// circles, files that load each other in a circle or more than 8 deep. Its materials have no colour.
Result<Soup> read_cao(const std::filesystem::path& path);

}  // namespace cgsr::world
