#include <algorithm>

#include "src/boot/run_loops.h"
#include "src/output/progress.h"
#include "src/tasks/capture_task.h"
#include "src/tasks/motion_task.h"

#include <fmt/format.h>

namespace cgsr::boot {
namespace {

/// Motion and switches on the time line of the stamps: every control cycle up to a given time, none twice.
class ControlCycles {
 public:
  /// \param simulation  the world that moves along; null: none does.
  ControlCycles(tasks::MotionTask& motion, tasks::SwitchTask& switches, SimulatedClock& clock,
                hal::Simulation* simulation)
      : motion_(motion), switches_(switches), clock_(clock), simulation_(simulation) {}

  void advance_to(MonoTime time) {
    for (; next_cycle_ <= time; next_cycle_ += kMotionPeriod) {
      clock_.advance_to(next_cycle_);
      if (simulation_ != nullptr) simulation_->advance_to(next_cycle_);
      if (next_cycle_ >= next_look_) {
        static_cast<void>(switches_.step());
        next_look_ += tasks::kSwitchPeriod;
      }
      motion_.step(next_cycle_);
    }
    clock_.advance_to(time);
    if (simulation_ != nullptr) simulation_->advance_to(time);
  }

  [[nodiscard]] MonoTime last() const { return next_cycle_ - kMotionPeriod; }

 private:
  tasks::MotionTask& motion_;
  tasks::SwitchTask& switches_;
  SimulatedClock& clock_;
  hal::Simulation* simulation_;
  MonoTime next_cycle_{};
  MonoTime next_look_{};
};

}  // namespace

Result<void> camera_outcome(const RobotState& state) {
  if (!state.links.camera_lost.load(std::memory_order_acquire)) return {};
  return fail(fmt::format("camera: {}", state.devices.camera->last_problem()));
}

// A slow machine changes nothing but how long it takes: a result reaches motion result_latency_s after its image's stamp. What the wheels were
// told until an image is there is told first: a simulated camera sees what came of it.
Result<void> run_lock_step(RobotState& state, StopRequest& stop) {
  const config::Run& run = state.setup.config.run;
  const RunOptions& options = state.setup.options;
  const Duration period = state.devices.mode.frame_period;
  SimulatedClock& stamps = state.clocks.stamps;
  tasks::CaptureTask capture(*state.devices.camera, period, state.links);
  tasks::VisionTask vision(*state.vision.loop, *state.vision.runner, state.surroundings(), stamps, period, state.links);
  tasks::MotionTask motion(*state.devices.base, stop, seconds(run.result_latency_s), options.arm, state.links);
  tasks::SwitchTask switches(*state.devices.switches, state.lines(), stamps, state.links);
  tasks::HousekeepingTask housekeeping(state.links, state.outputs.sinks);
  ControlCycles cycles(motion, switches, stamps, state.devices.simulation.get());
  app::Progress progress;

  const MonoTime end = options.duration_s > 0.0 ? MonoTime{seconds(options.duration_s)} : MonoTime::max();
  MonoTime due = state.devices.next_due;
  MonoTime not_before = state.clocks.real.now();
  for (; !stop.requested() && due < end; due += period) {
    cycles.advance_to(due);
    if (!capture.step(due)) break;
    if (!vision.step()) vision.step_without_image(due);
    housekeeping.step(due);
    const sinks::RunStatistics& so_far = state.outputs.statistics->run();
    progress.show(fmt::format("{:.1f} s   {} images, object in {}   {:+.2f} m/s", to_seconds(due.time_since_epoch()),
                              so_far.frames, so_far.found, so_far.last_motion.commanded.forward_mps));
    if (run.pace != config::Pace::kRealTime) continue;
    // Time that was lost is not caught up: simulated time slows instead.
    not_before = std::max(not_before + period, state.clocks.real.now());
    state.clocks.real.sleep_until(not_before);
  }
  stop.request();
  cycles.advance_to(cycles.last() + 2 * kMotionPeriod);
  motion.end();
  housekeeping.step(stamps.now());
  return camera_outcome(state);
}

}  // namespace cgsr::boot
