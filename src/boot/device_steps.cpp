// The steps that open devices: one factory for each kind.
#include "hal/dummy/dummy_switches.h"
#include "hal/dummy/kinematic_drive.h"
#include "hal/replay/replay_camera.h"
#include "hal/rmp/rmp_drive.h"
#include "src/boot/robot_plan.h"
#include "src/boot/simulation_plugin.h"

namespace cgsr::boot {
namespace {

std::unique_ptr<hal::Drive> make_drive(RobotState& state) {
  const config::Robot& config = state.setup.config;
  if (state.devices.simulation) {
    return std::make_unique<hal::rmp::RmpDrive>(state.devices.simulation->take_can_bus(), config.rmp);
  }
  return std::make_unique<hal::KinematicDrive>(config.drive);
}

std::unique_ptr<hal::Switches> make_switches(RobotState& state) {
  if (state.devices.simulation) return state.devices.simulation->take_switches();
  const config::Switches& names = state.setup.config.switches;
  std::vector<hal::DummyLine> lines;
  if (!names.arming_line.empty()) lines.push_back({names.arming_line, hal::LineDirection::kInput, false});
  for (const std::string& lamp : names.lamps()) {
    if (!lamp.empty()) lines.push_back({lamp, hal::LineDirection::kOutput, false});
  }
  return std::make_unique<hal::DummySwitches>(std::move(lines));
}

}  // namespace

Result<void> open_simulation(RobotState& state) {
  if (state.setup.config.camera.source != config::CameraSource::kSim) return {};
  auto simulation = load_simulation(state.setup.config.sim);
  if (!simulation) return tl::unexpected(simulation.error());
  state.devices.simulation = std::move(*simulation);
  for (const std::string& note : state.devices.simulation->notes()) state.report.notes.push_back(note);
  return {};
}

Result<void> open_camera(RobotState& state) {
  Devices& devices = state.devices;
  if (devices.simulation) {
    devices.camera = devices.simulation->take_camera();
    devices.next_due = MonoTime{devices.simulation->image_delay()};
  } else {
    auto camera = std::make_unique<hal::ReplayCamera>(state.setup.config.camera.replay, &state.clocks.real);
    auto mode = camera->start();
    if (!mode) return tl::unexpected(mode.error());
    for (const std::string& note : camera->notes()) state.report.notes.push_back(note);
    devices.mode = *mode;
    devices.camera = std::move(camera);
    return {};
  }
  auto mode = devices.camera->start();
  if (!mode) return tl::unexpected(mode.error());
  devices.mode = *mode;
  return {};
}

Result<void> open_base(RobotState& state) {
  state.devices.base =
      std::make_unique<MotionLoop>(make_drive(state), state.setup.config.motion,
                                   state.setup.options.dry_run ? MotionLoop::Mode::kDryRun : MotionLoop::Mode::kLive);
  return state.devices.base->start();
}

Result<void> open_switches(RobotState& state) {
  state.devices.switches = make_switches(state);
  if (auto started = state.devices.switches->start(); !started) return started;
  auto checked = tasks::check_lines(*state.devices.switches, state.lines());
  if (!checked) state.devices.switches->stop();
  return checked;
}

}  // namespace cgsr::boot
