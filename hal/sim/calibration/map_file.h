#pragma once

#include <filesystem>
#include <string>

#include "hal/sim/scene/scene.h"
#include "platform/error.h"

namespace cgsr::sim {

/// The static geometry that a robot's map holds (parts that are `in_map`) as Wavefront OBJ: an object per part, a face per polygon with its
/// outline counter-clockwise, corners shared within a part. Metres, z up. Numbers are written so that they read back exactly.
///
/// \param comment  lines for the head of the file, without '#'.  \param materials_file  the name that `mtllib` gives.
std::string map_as_obj(const Scene& scene, const std::string& materials_file, const std::string& comment);

/// Its materials: Kd is the mean colour of the surface, pattern included, sRGB-encoded; Ks and Pr its gloss; Ke where it glows.
std::string materials_as_mtl(const Scene& scene, const std::string& comment);

/// Writes `obj` and, beside it, the materials under the same name with `.mtl`.
Result<void> write_map(const Scene& scene, const std::filesystem::path& obj, const std::string& comment);

}  // namespace cgsr::sim
