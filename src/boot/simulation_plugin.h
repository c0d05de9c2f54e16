#pragma once

#include <memory>

#include "hal/simulation.h"
#include "platform/error.h"

namespace cgsr::boot {

/// Loads the simulator's shared library and makes the home that `parameters` name. The program itself links none of it.
///
/// \return what is wrong: the library is missing, is none of ours or is of another version (each with its path), or every
/// problem of the scenario.
Result<std::unique_ptr<hal::Simulation>> load_simulation(const hal::SimulationParameters& parameters);

}  // namespace cgsr::boot
