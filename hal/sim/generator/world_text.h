#pragma once

#include <string>

#include "hal/sim/worlds/world_spec.h"

namespace cgsr::sim {

/// \return the world as a file says it: what differs from the defaults, in the order of docs/worlds.md. Numbers read back exactly.
/// \param comment  lines for its head, without '#'.
std::string world_as_toml(const WorldSpec& world, const std::string& comment);

}  // namespace cgsr::sim
