#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "pipeline/world/file_text.h"
#include "pipeline/world/soup.h"
#include "platform/error.h"

namespace cgsr::world {

/// How much may be in a model with all the files that it loads, each as often as it is loaded. Faces and their corners: kLargestFaces, kLargestCorners.
struct CaoLimits {
  std::size_t points = kLargestCorners;
  std::size_t lines = kLargestCorners;
  std::uintmax_t bytes = kLargestBytes;
};

/// Reads ViSP's model files (.cao, version 1): 3D points, 3D lines, faces from lines and from points, and other files that it loads, with their
/// `t=[x; y; z]` and `tu=[x; y; z]` (radians). A line's or face's options (name, useLod, ...) are read over. Refused by name: cylinders and
/// circles, files that load each other in a circle or more than 8 deep, more than the limits in all. Its materials have no colour. Ours; the format is that of ViSP (Marchand et al. 2005).
Result<Soup> read_cao(const std::filesystem::path& path, const CaoLimits& limits = {});

}  // namespace cgsr::world
