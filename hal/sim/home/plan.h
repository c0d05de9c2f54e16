#pragma once

#include "hal/sim/scene/scene.h"
#include "hal/simulation.h"

namespace cgsr::sim {

/// \return the static parts of the scene as they look from above, below `ceiling_m`.
hal::Plan make_plan(const Scene& scene, double ceiling_m = 2.2);

}  // namespace cgsr::sim
