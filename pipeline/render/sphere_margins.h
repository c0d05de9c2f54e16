#pragma once

#include <cstddef>

#include "pipeline/render/sphere_groups.h"

namespace cgsr::render {

/// How far each centre lies inside of the frustum's nearest plane (2.2), metres; negative: outside.
///
/// \param x, y, z  `count` centres in W, metres.  \param out  `count` values.
void margins_in(const Frustum& frustum, const float* x, const float* y, const float* z, std::size_t count, float* out);

}  // namespace cgsr::render
