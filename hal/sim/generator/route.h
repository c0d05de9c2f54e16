#pragma once

#include <optional>
#include <vector>

#include "hal/sim/generator/site.h"

namespace cgsr::sim {

/// A way through every room and back, straight from place to place.
struct Route {
  FloorPoint start;
  double start_heading_deg = 0.0;  ///< towards the first place.
  std::vector<FloorPoint> places;  ///< the last one is the start.
  double length_m = 0.0;
};

/// Draws a place in each room and joins them through the doors, each crossed at right angles in its middle. Every straight piece is free for a
/// disc of kRobotRadius_m. \return nothing when there is no such way.
std::optional<Route> draw_route(const Site& site, Draw& draw);

}  // namespace cgsr::sim
