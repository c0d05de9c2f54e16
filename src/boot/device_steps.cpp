// The steps that open devices. Which one each of them is: device_kinds.h.
#include <utility>

#include "src/boot/device_kinds.h"
#include "src/boot/device_wait.h"
#include "src/boot/robot_plan.h"
#include "src/boot/simulation_plugin.h"

namespace cgsr::boot {
namespace {

DeviceContext context_of(RobotState& state) {
  return {state.setup.config, state.devices.simulation.get(), state.devices.simulation_origin, state.clocks.real};
}

/// Opens a device. One of this computer may be late: then, as the options say, it is waited for, or `check` lets it be.
/// \param real  it is one of this computer.
template <class Open>
auto open_device(RobotState& state, const char* name, bool real, Open open) {
  const RunOptions& options = state.setup.options;
  if (!real) return open();
  if (options.wait_for_devices != nullptr) {
    return open_when_there(name, state.clocks.real, *options.wait_for_devices, open);
  }
  auto opened = open();
  if (!opened) state.report.missing_devices.push_back(opened.error().message);
  return opened;
}

}  // namespace

/// The simulated home, where some device is part of it.
Result<void> open_simulation(RobotState& state) {
  const config::Robot& config = state.setup.config;
  if (!config.simulated()) return {};
  auto simulation = load_simulation(config.sim);
  if (!simulation) return tl::unexpected(simulation.error());
  state.devices.simulation = std::move(*simulation);
  if (state.setup.live()) state.devices.simulation_origin = state.clocks.real.now();
  for (const std::string& note : state.devices.simulation->notes()) state.report.notes.push_back(note);
  if (config.simulated_camera() && !config.simulated_base()) {
    state.report.notes.emplace_back("the simulated camera stands still: the base is not the simulated Segway");
  }
  return {};
}

Result<void> start_camera(RobotState& state) {
  auto opened = open_device(state, "camera", state.setup.config.real_camera(),
                            [&state] { return open_camera(context_of(state)); });
  if (!opened) return tl::unexpected(opened.error());
  Devices& devices = state.devices;
  devices.camera = std::move(opened->camera);
  devices.mode = opened->mode;
  devices.next_due = opened->first_due;
  for (const std::string& note : opened->notes) state.report.notes.push_back(note);
  return {};
}

Result<void> start_base(RobotState& state) {
  auto drive = make_base(context_of(state));
  if (!drive) return tl::unexpected(drive.error());
  state.devices.base =
      std::make_unique<MotionLoop>(std::move(*drive), state.setup.config.motion,
                                   state.setup.options.dry_run ? MotionLoop::Mode::kDryRun : MotionLoop::Mode::kLive);
  return open_device(state, "base", state.setup.config.real_base(), [&state] { return state.devices.base->start(); });
}

Result<void> start_switches(RobotState& state) {
  auto switches = make_switches(context_of(state));
  if (!switches) return tl::unexpected(switches.error());
  state.devices.switches = std::move(*switches);
  auto started = open_device(state, "lines", state.setup.config.real_switches(),
                             [&state] { return state.devices.switches->start(); });
  if (!started) return started;
  auto checked = tasks::check_lines(*state.devices.switches, state.lines());
  if (!checked) state.devices.switches->stop();
  return checked;
}

}  // namespace cgsr::boot
