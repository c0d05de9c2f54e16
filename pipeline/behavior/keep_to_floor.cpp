#include "pipeline/behavior/keep_to_floor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::behavior {

Velocity keep_to_floor(const FreeFloor& floor, const PlanarPose& here, Velocity wanted, double deceleration_mps2) {
  constexpr double kMargin_m = 0.05;  // a cell
  if (!here.known || wanted.forward_mps == 0.0) return wanted;
  const double speed_mps = std::abs(wanted.forward_mps);
  const double heading_rad = here.heading_rad + (wanted.forward_mps < 0.0 ? std::numbers::pi : 0.0);
  const double needed_m = speed_mps * speed_mps / (2.0 * deceleration_mps2) + kMargin_m;
  const double way_m = std::max(0.0, floor.way_m(here.x_m, here.y_m, heading_rad, needed_m) - kMargin_m);
  const double most_mps = std::sqrt(2.0 * deceleration_mps2 * way_m);
  wanted.forward_mps = std::clamp(wanted.forward_mps, -most_mps, most_mps);
  return wanted;
}

}  // namespace cgsr::behavior
