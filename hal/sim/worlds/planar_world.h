#pragma once

#include "hal/sim/worlds/world_spec.h"

namespace cgsr::sim {

/// The planar world of section 4.3.2: a 4 x 4 field of cross-hatched tape, a RoboCup Standard Platform League field, four white boards, two
/// 9 x 7 checkerboards and two goals. With 456 edges it is exactly that: 43 rectangles of 4 edges and two boards of 63 squares that share
/// theirs (142 each), 169 surfaces in all.
///
/// Fewer edges take away detail: first the squares, then lines of the field, then tape. More add boxes (6 surfaces, 12 edges) behind the
/// robot's start, where its camera does not see them. The robot starts at the origin and looks along x.
///
/// Appends to `world`: materials (prefix "planar "), shapes; the number of edges is within 11 of `planar.edges`, never more.
void add_planar_world(const PlanarSpec& planar, WorldSpec& world);

}  // namespace cgsr::sim
