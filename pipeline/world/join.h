#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/world/map.h"
#include "platform/error.h"

namespace cgsr::world {

/// Connected coplanar triangles of one material become surfaces. Fills map.triangles (wound about their surface's normal) and map.surfaces.
/// A triangle of the same corners as an earlier one goes, and so does a surface with the outline of an earlier one: sheets given twice.
/// \param triangles  indices into map.vertices, none without area.  \param materials  of each.  \param one_sided  they are seen from the front alone: a surface
///        is two-sided then where it was given front and back.
/// Error: more than kLargestFan triangles share one edge. Ours.
Result<void> join(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& materials, double weld_m,
                  bool one_sided, Map& map);

}  // namespace cgsr::world
