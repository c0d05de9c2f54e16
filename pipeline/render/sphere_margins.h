#pragma once

#include <cstddef>

#include "pipeline/render/sphere_groups.h"

namespace cgsr::render {

/// How far each centre lies inside of the frustum's nearest plane, metres; negative: outside.
void margins_in(const Frustum& frustum, const float* x, const float* y, const float* z, std::size_t count, float* out);

}  // namespace cgsr::render
