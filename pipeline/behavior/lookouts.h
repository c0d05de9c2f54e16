#pragma once

#include <vector>

#include "pipeline/behavior/free_floor.h"
#include "pipeline/behavior/place.h"

namespace cgsr::behavior {

/// From where to where somebody can be seen.
struct LookoutParameters {
  double min_distance_m = 0.7;  ///< nearer faces lie above the image.
  double max_distance_m = 2.5;  ///< farther faces are too small to be named.
  double max_unseen_share =
      0.03;  ///< of the floor on which people may stand, that the lookouts together may leave unseen.
  FreeFloorParameters floor{};  ///< where the robot may drive.
};

/// The places from which the whole free floor of a home is seen by a robot that turns round, in the order of a short tour.
struct LookoutPlan {
  std::vector<Place> lookouts;  ///< at most kMaxLookouts.
  double seen_share = 0.0;      ///< of the floor on which people may stand and that any reachable place sees.

  static constexpr std::size_t kMaxLookouts = 24;
};

/// Plans the lookouts (6.4.1.2): of the places that the robot reaches from `start` the one that sees most of what is not seen yet, until enough is
/// seen (the greedy set cover, Chvatal 1979); the tour visits the nearest next and is then shortened by reversing parts of it (2-opt, Croes 1958).
/// A wall, shelf or anything else between 1.2 and 1.7 m high hides who stands behind it.
///
/// Cost: 1.1 billion instructions for the simulated home, most of them for lines of sight; for the boot, not for a frame. Allocates.
LookoutPlan plan_lookouts(const world::Map& map, const Place& start, const LookoutParameters& parameters);

}  // namespace cgsr::behavior
