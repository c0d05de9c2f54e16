#pragma once

#include "pipeline/behavior/free_floor.h"
#include "pipeline/behavior/route.h"
#include "pipeline/behavior/velocity.h"

namespace cgsr::behavior {

/// What a behaviour that knows no map may do of what it wants: it turns as it likes, and drives no faster than it can stop within the map's free floor ahead of it,
/// or behind it where it drives backwards. Where it stands on no free floor it drives slowly to where some begins within .3 m, and nowhere else. Where the pose is not known nothing is limited: what is not free is not known either.
/// Ours: 6.4 follows people with nothing in the way.
/// \param deceleration_mps2  with which it brakes, > 0.
Velocity keep_to_floor(const FreeFloor& floor, const PlanarPose& here, Velocity wanted, double deceleration_mps2);

}  // namespace cgsr::behavior
