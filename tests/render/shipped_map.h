#pragma once

#include <string>

#include "pipeline/world/map.h"

namespace cgsr::render {

/// The map of a shipped world (config/worlds), exported by the simulator and loaded as the robot loads it. Fails the running test when it cannot.
world::Map shipped_map(const std::string& name);

}  // namespace cgsr::render
