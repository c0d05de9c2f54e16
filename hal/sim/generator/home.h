#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/sim/generator/floor_plan.h"
#include "hal/sim/generator/furnish.h"
#include "hal/sim/generator/lights.h"
#include "hal/sim/generator/route.h"
#include "hal/sim/worlds/world_spec.h"
#include "platform/error.h"

namespace cgsr::sim {

inline constexpr std::uint32_t kMaxHomeSeed = 1'000'000'000;

/// A home that nobody drew by hand: what its world file says, and what is known about it.
struct GeneratedHome {
  std::uint32_t seed = 0;
  WorldSpec world;
  FloorPlan plan;
  Route route;
  Furnished furnished;
  Lights lights;
  std::vector<std::string> rejected;  ///< draws before this one, and why each was drawn again.
};

/// Draws a home from a seed: the same one with every compiler. Each draw is checked: every room can be driven through, every lamp is seen by the
/// probes from somewhere, there is a way through all rooms and back; one that fails is drawn again, kMaxDraws times at most. Ours.
/// \return an error when the seed is out of range, or with the last reason when no draw held.
Result<GeneratedHome> generate_home(std::uint32_t seed);

inline constexpr int kMaxDraws = 40;

}  // namespace cgsr::sim
