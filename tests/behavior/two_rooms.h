#pragma once

#include "pipeline/world/map.h"

namespace cgsr::behavior::test {

/// Two rooms of 4 m x 5 m side by side; a wall at x = 4 m with a door from y = 3.8 to 4.8 m between them; a table that robots do not get through and
/// that hides nobody in the first one.
inline world::Map two_rooms(bool with_door = true) {
  world::Map map;
  const auto wall = [&map](float x0, float y0, float x1, float y1, float height) {
    const auto first = static_cast<std::uint32_t>(map.vertices.size());
    for (const Eigen::Vector3f& corner : {Eigen::Vector3f{x0, y0, 0}, {x1, y1, 0}, {x1, y1, height}, {x0, y0, height}})
      map.vertices.push_back(corner);
    map.triangles.push_back({first, first + 1, first + 2});
    map.triangles.push_back({first, first + 2, first + 3});
  };
  wall(0, 0, 8, 0, 2.5F);
  wall(8, 0, 8, 5, 2.5F);
  wall(8, 5, 0, 5, 2.5F);
  wall(0, 5, 0, 0, 2.5F);
  wall(4, 0, 4, with_door ? 3.8F : 5.0F, 2.5F);
  wall(4, 4.8F, 4, 5, 2.5F);
  wall(1.6F, 2.0F, 2.4F, 2.0F, 0.7F);
  wall(2.4F, 2.0F, 2.4F, 2.8F, 0.7F);
  wall(2.4F, 2.8F, 1.6F, 2.8F, 0.7F);
  wall(1.6F, 2.8F, 1.6F, 2.0F, 0.7F);
  return map;
}

}  // namespace cgsr::behavior::test
