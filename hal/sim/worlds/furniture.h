#pragma once

#include <string>
#include <vector>

#include "hal/sim/scene/mesh.h"
#include "hal/sim/worlds/shape_spec.h"

namespace cgsr::sim {

/// One piece of something composed.
struct Piece {
  std::string name;
  Mesh mesh;
  bool second = false;  ///< of the second material.
  bool casts_shadow = true;
  bool detail = false;  ///< too small to be worth a place in a map: handles, books, legs of chairs.
};

/// The pieces of a shape that fills `spec.size_m`, standing on the origin, facing +x: one for a primitive, many for furniture. Meshes from
/// files are not its business.
std::vector<Piece> pieces_of(const ShapeSpec& spec);

}  // namespace cgsr::sim
