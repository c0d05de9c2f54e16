#pragma once

#include "hal/sim/scene/scene.h"

namespace cgsr::sim {

/// How large the map of a scene is: its polygons, and the outline edges of them, an edge that two polygons share counted once. Corners
/// closer than 0.1 mm are the same. Only static parts that are `in_map` count; of curved ones every facet does.
struct MapCount {
  int surfaces = 0;
  int edges = 0;
};
MapCount count_map(const Scene& scene);

}  // namespace cgsr::sim
