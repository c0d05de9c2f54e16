#include "src/boot/simulation_plugin.h"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "src/plug_in/library.h"

namespace cgsr::boot {
namespace {

constexpr const char* kPlugInName = "cgsr-simulation.so";

Result<std::string> path_of(const hal::SimulationParameters& parameters) {
  if (!parameters.plug_in.empty()) return parameters.plug_in;
  return PlugInLibrary::beside_program(kPlugInName);
}

}  // namespace

Result<std::unique_ptr<hal::Simulation>> load_simulation(const hal::SimulationParameters& parameters) {
  const auto path = path_of(parameters);
  if (!path) return tl::unexpected(path.error());
  const auto library = PlugInLibrary::open(*path);
  if (!library) return fail(fmt::format("the simulator's plug-in cannot be loaded: {}", library.error().message));
  auto* const version = library->function<hal::SimulationVersion>(hal::kSimulationVersionSymbol);
  auto* const make = library->function<hal::MakeSimulation>(hal::kMakeSimulationSymbol);
  if (version == nullptr || make == nullptr) {
    return fail(fmt::format("{}: is no simulator of this program: it does not export {} and {}", *path,
                            hal::kSimulationVersionSymbol, hal::kMakeSimulationSymbol));
  }
  if (version() != hal::kSimulationVersion) {
    return fail(fmt::format("{}: is a simulator of version {}, this program needs version {}: build both together",
                            *path, version(), hal::kSimulationVersion));
  }
  std::string problems;
  std::unique_ptr<hal::Simulation> simulation(make(&parameters, &problems));
  if (!simulation) return fail(std::move(problems));
  return simulation;
}

}  // namespace cgsr::boot
