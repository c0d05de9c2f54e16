#pragma once

#include "hal/sim/generator/site.h"

namespace cgsr::sim {

/// Floors, walls with their openings, door frames, skirtings, windows with sill, bars and curtains, the sky behind them, the front door, the
/// ceiling. The sky does not glow yet.
void build_shell(Site& site, Draw& draw);

}  // namespace cgsr::sim
