#pragma once

#include "pipeline/world/map.h"

namespace cgsr::world {

/// Fills sides and contrast of every edge (map.h): what covers a surface at its edge, and what a border lies on or ends at, is looked for along
/// rays of at most lies_on_m at five places of the edge; the answer is what at least three of them find. Ours, for the appearance of section 4.2.
void look_beside(double lies_on_m, Map& map);

/// \return the contrast expected of an edge whose sides are known: the root of the squares of the difference of luma and of a quarter of the
///         mean luma times the sine of the angle between the two planes, which are lit differently.
float expected_contrast(const Map& map, const Edge& edge);

}  // namespace cgsr::world
