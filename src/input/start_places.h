#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "pipeline/world/map.h"
#include "platform/error.h"

namespace cgsr::app {

/// Where on a map's free floor a robot may have been put down: a grid for the search for its first pose.
///
/// \param map_file  for messages.
/// \return places on the floor, in W; or that the map has no free floor, or covers more than is searched.
Result<std::vector<Eigen::Vector2d>> start_places(const world::Map& map, const std::string& map_file);

}  // namespace cgsr::app
