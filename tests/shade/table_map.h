#pragma once

#include "pipeline/world/map.h"
#include "tests/render/box_map.h"

namespace cgsr::shade {

/// A floor of 12 x 12 m and a board of 1.2 x 0.8 m over its middle. \param top_m, thickness_m  of the board.
inline world::Map table_over_floor(float top_m = 0.75F, float thickness_m = 0.03F) {
  world::Map map;
  render::add_rectangle(map, {-6.0F, -6.0F, 0.0F}, {12.0F, 0.0F, 0.0F}, {0.0F, 12.0F, 0.0F});
  render::add_box(map, {-0.6F, -0.4F, top_m - thickness_m}, {0.6F, 0.4F, top_m});
  return map;
}

}  // namespace cgsr::shade
