#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hal/sim/scene/material.h"
#include "hal/sim/scene/mesh.h"
#include "platform/error.h"

namespace cgsr::sim {

/// A surface of a mesh file with its own material.
struct FilePiece {
  std::string name;
  Mesh mesh;
  Material material;
};

/// Reads OBJ (with MTL) or glTF through assimp. Metres are `scale` times the file's units. glTF's y-up becomes z-up; OBJ is taken as it
/// is. Kd or base colour become the albedo (OBJ's as sRGB, glTF's as linear, as their makers mean them), Pr or Ns the roughness.
/// Refused with the file's name: what is missing, larger than 64 MB, unreadable, empty, or has a corner that is not finite.
/// Not read: textures, transparency, animation.
Result<std::vector<FilePiece>> read_mesh_file(const std::filesystem::path& file, double scale);

}  // namespace cgsr::sim
