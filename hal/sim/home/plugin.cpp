// What the shared library cgsr-simulation.so exports: src/boot/simulation_plugin.cpp looks for these two names.
#include <exception>
#include <string>

#include "hal/sim/home/simulated_home.h"
#include "hal/simulation.h"

using cgsr::hal::Simulation;
using cgsr::hal::SimulationParameters;

extern "C" __attribute__((visibility("default"))) int cgsr_simulation_version() {
  return cgsr::hal::kSimulationVersion;
}

// No exception may cross into the program.
extern "C" __attribute__((visibility("default"))) Simulation* cgsr_make_simulation(
    const SimulationParameters* parameters, std::string* error) try {
  auto home = cgsr::sim::SimulatedHome::make(*parameters);
  if (home) return home->release();
  *error = home.error().message;
  return nullptr;
} catch (const std::exception& caught) {
  *error = std::string("the simulator failed: ") + caught.what();
  return nullptr;
}
