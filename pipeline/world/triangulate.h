#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/world/map.h"

namespace cgsr::world {

/// Cuts an outline into triangles by taking off ears (Meisters 1975), in the plane of its area vector; concave outlines and corners in the middle of a straight
/// side come out right. What cannot be cut (it crosses itself, it has no area) is left out.
/// \param outline  indices into points.  \param triangles  appended to, wound as the outline.
void triangulate(std::span<const std::uint32_t> outline, std::span<const Eigen::Vector3f> points,
                 std::vector<Triangle>& triangles);

}  // namespace cgsr::world
