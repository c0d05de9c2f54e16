#include "pipeline/behavior/keep_to_floor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::behavior {
namespace {

constexpr double kBack_mps = 0.1;  // where the robot is not on free floor

// Whether free floor begins a few cells away: the pose was corrected, or the robot was armed beside a wall.
bool leads_back(const FreeFloor& floor, const PlanarPose& here, double heading_rad) {
  constexpr double kFarthest_m = 0.3, kStep_m = 0.05;
  for (double m = kStep_m; m <= kFarthest_m; m += kStep_m)
    if (floor.is_free(here.x_m + m * std::cos(heading_rad), here.y_m + m * std::sin(heading_rad))) return true;
  return false;
}

}  // namespace

Velocity keep_to_floor(const FreeFloor& floor, const PlanarPose& here, Velocity wanted, double deceleration_mps2) {
  constexpr double kMargin_m = 0.05;  // a cell
  if (!here.known || wanted.forward_mps == 0.0) return wanted;
  const double speed_mps = std::abs(wanted.forward_mps);
  const double heading_rad = here.heading_rad + (wanted.forward_mps < 0.0 ? std::numbers::pi : 0.0);
  if (!floor.is_free(here.x_m, here.y_m)) {
    const double most_mps = leads_back(floor, here, heading_rad) ? kBack_mps : 0.0;
    wanted.forward_mps = std::clamp(wanted.forward_mps, -most_mps, most_mps);
    return wanted;
  }
  const double needed_m = speed_mps * speed_mps / (2.0 * deceleration_mps2) + kMargin_m;
  const double way_m = floor.way_m(here.x_m, here.y_m, heading_rad, needed_m);
  if (way_m >= needed_m) return wanted;
  const double most_mps = std::sqrt(2.0 * deceleration_mps2 * std::max(0.0, way_m - kMargin_m));
  wanted.forward_mps = std::clamp(wanted.forward_mps, -most_mps, most_mps);
  return wanted;
}

}  // namespace cgsr::behavior
