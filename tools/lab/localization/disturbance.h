#pragma once

#include "hal/sim/scene/scene.h"
#include "hal/sim/worlds/world.h"
#include "tools/lab/localization/standpoints.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {

/// Everything in the map a metre from where it is, each thing its own way: a room that was furnished anew.
void scatter(sim::Scene& map, Random random);

/// The whole map a metre aside.
void displace(sim::Scene& map, Random random);

/// Puts one to three people or pieces of furniture that the map does not hold before the camera.
void obstruct(sim::WorldSpec& spec, const Standpoint& at, Random random);

}  // namespace cgsr::lab
