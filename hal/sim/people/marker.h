#pragma once

#include "hal/sim/scene/mesh.h"

namespace cgsr::sim {

/// An ArUco marker of OpenCV's DICT_4X4_50 as a mesh of squares, with its white margin, about the origin, facing +x, z up. Polygons of
/// black squares have u = 1, of white ones u = 0.
Mesh marker_mesh(int id, double side_m);

/// The black or the white squares of it.
Mesh sheet_of(const Mesh& marker, bool black);

}  // namespace cgsr::sim
