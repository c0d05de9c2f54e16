#pragma once

#include <filesystem>
#include <string_view>

#include "pipeline/world/map.h"
#include "platform/error.h"

namespace cgsr::world {

/// Which of the file's axes points up. Ours is z; from y up, (x, y, z) of the file becomes (x, -z, y).
enum class UpAxis : std::uint8_t {
  kByFormat,  ///< glTF: y, as its specification says; all else: z.
  kZ,
  kY,
};
/// \return the word of --up.
std::string_view to_string(UpAxis axis);

struct LoadOptions {
  UpAxis up = UpAxis::kByFormat;
  double scale = 1.0;       ///< metres per unit of the file.
  double weld_m = 1e-4;     ///< corners closer than this are one.
  double lies_on_m = 0.02;  ///< what is closer than this to a surface lies on it.
};

/// Reads a map and cleans it up (clean.h). By the name's ending: `.obj` with its `.mtl`, `.gltf` and `.glb`, ViSP's `.cao`, and `.cgsrmap`, our
/// own compact copy (compact.h), which was cleaned up already: the options do not matter to it.
/// Errors name the file and, where there is one, the line: what cannot be read, no surface in it, numbers that are not finite, more than 1000 km
/// across, more bytes, corners or faces than kLargest… allow.
Result<Map> load_map(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace cgsr::world
