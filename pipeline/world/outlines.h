#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/world/map.h"

namespace cgsr::world {

/// Fills map.edges from the outlines of map.surfaces: vertices, surfaces and kind; not yet sides and contrast. See clean(). Ours, for the edges of section 4.2.
/// \param lines  that the file draws itself; those that an edge covers anyway are left out.
/// \param diagonals  along which one face that is not quite plane was cut into triangles: sorted, the lower vertex first. Where nothing else meets, they
///        are no edges.
/// \return false when the outlines lie so much among each other that it would take too long.
bool trace_outlines(const std::vector<std::array<std::uint32_t, 2>>& lines,
                    const std::vector<std::array<std::uint32_t, 2>>& diagonals, double weld_m, Map& map);

}  // namespace cgsr::world
