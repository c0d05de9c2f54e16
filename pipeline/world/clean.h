#pragma once

#include "pipeline/world/map.h"
#include "pipeline/world/soup.h"
#include "platform/error.h"

namespace cgsr::world {

/// Makes a map of what a file says, with the unique edges of section 4.2; how is ours:
/// - corners closer than weld_m are one; faces become triangles; those without area (lower than weld_m) and those given twice go;
/// - connected coplanar triangles of one material become a surface, however they are wound (its normal is the largest one's); a sheet given
///   twice, front and back, is one surface;
/// - outlines are cut where the end of another one touches them, so that every piece has its true neighbours; pieces with the same neighbours
///   in one straight line are one edge again. No edge: where a surface meets itself, or one of its own material in its own plane;
/// - what each edge is seen against is looked for along short rays, see Edge::sides, at several places of it: what most of them say;
/// - edges, surfaces and triangles are put in spatial order.
/// Errors: no surface with an area, numbers that are not finite, more than kLargestExtent_m across, more than kLargest… corners or
/// faces, more than kLargestFan triangles at one edge.
Result<Map> clean(const Soup& soup, double weld_m, double lies_on_m);

}  // namespace cgsr::world
