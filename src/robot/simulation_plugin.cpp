#include "src/robot/simulation_plugin.h"

#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>

namespace cgsr::robot {
namespace {

constexpr const char* kPlugInName = "cgsr-simulation.so";

Result<std::string> path_of(const hal::SimulationParameters& parameters) {
  if (!parameters.plug_in.empty()) return parameters.plug_in;
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return fail(fmt::format("where the program lies cannot be found out: {}", error.message()));
  return (program.parent_path() / kPlugInName).string();
}

/// \return a function of the library; null when it has none of that name.
template <class Function>
Function* function_of(void* library, const char* name) {
  return reinterpret_cast<Function*>(dlsym(library, name));
}

std::string last_words() {
  const char* words = dlerror();
  return words == nullptr ? "no reason given" : words;
}

}  // namespace

Result<std::unique_ptr<hal::Simulation>> load_simulation(const hal::SimulationParameters& parameters) {
  const auto path = path_of(parameters);
  if (!path) return tl::unexpected(path.error());
  // Never closed again: the ray tracer's threads would lose the ground under their feet.
  void* library = dlopen(path->c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library == nullptr) return fail(fmt::format("the simulator's plug-in cannot be loaded: {}", last_words()));
  auto* const version = function_of<hal::SimulationVersion>(library, hal::kSimulationVersionSymbol);
  auto* const make = function_of<hal::MakeSimulation>(library, hal::kMakeSimulationSymbol);
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

}  // namespace cgsr::robot
