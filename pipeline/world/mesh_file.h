#pragma once

#include <filesystem>

#include "pipeline/world/load.h"
#include "pipeline/world/soup.h"
#include "platform/error.h"

namespace cgsr::world {

/// Reads OBJ with MTL and glTF by assimp, faces as they stand in the file. Colours: Kd as it is (sRGB), glTF's base colour from linear; a material
/// with a picture, or that the file does not have, has no known colour. Ours.
Result<Soup> read_mesh_file(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace cgsr::world
