#include <algorithm>

#include "src/output/progress.h"
#include "src/robot/capture_task.h"
#include "src/robot/motion_task.h"
#include "src/robot/robot.h"
#include "src/robot/switch_task.h"
#include "src/robot/vision_task.h"

#include <fmt/core.h>

namespace cgsr::robot {
namespace {

/// Motion and switches on the time line of the stamps: every beat up to a given time, none twice.
class Beats {
 public:
  /// \param simulation  the world that moves along; null: none does.
  Beats(MotionTask& motion, SwitchTask& switches, SimulatedClock& clock, hal::Simulation* simulation)
      : motion_(motion), switches_(switches), clock_(clock), simulation_(simulation) {}

  void advance_to(MonoTime time) {
    for (; next_beat_ <= time; next_beat_ += kMotionPeriod) {
      clock_.advance_to(next_beat_);
      if (simulation_ != nullptr) simulation_->advance_to(next_beat_);
      if (next_beat_ >= next_look_) {
        static_cast<void>(switches_.step());
        next_look_ += kSwitchPeriod;
      }
      motion_.step(next_beat_);
    }
    clock_.advance_to(time);
    if (simulation_ != nullptr) simulation_->advance_to(time);
  }

  [[nodiscard]] MonoTime last() const { return next_beat_ - kMotionPeriod; }

 private:
  MotionTask& motion_;
  SwitchTask& switches_;
  SimulatedClock& clock_;
  hal::Simulation* simulation_;
  MonoTime next_beat_{};
  MonoTime next_look_{};
};

}  // namespace

/// One thread steps all tasks in the order of docs/architecture.md. The stamps are the time, so a slow machine changes nothing but how
/// long it takes; a result reaches motion result_latency_s after its image's stamp. What the wheels were told until an image is there is
/// told first: a simulated camera sees what came of it.
void Robot::run_lock_step(StopRequest& stop) {
  CaptureTask capture(*camera_, mode_.frame_period, links_);
  VisionTask vision(*vision_, *runner_, stamp_clock_, mode_.frame_period, links_);
  MotionTask motion(*motion_, stop, seconds(config_.run.result_latency_s), options_.arm, links_);
  SwitchTask switches(*switches_, lines(), stamp_clock_, links_);
  Beats beats(motion, switches, stamp_clock_, simulation_.get());
  app::Progress progress;

  const bool real_time = config_.run.pace == config::Pace::kRealTime;
  const MonoTime end = options_.duration_s > 0.0 ? MonoTime{seconds(options_.duration_s)} : MonoTime::max();
  MonoTime due = first_due_;
  MonoTime not_before = real_clock_.now();
  for (; !stop.requested() && due < end; due += mode_.frame_period) {
    beats.advance_to(due);
    if (!capture.step(due)) break;
    if (!vision.step()) vision.step_without_image(due);
    housekeeping_->step();
    const auto& tally = housekeeping_->tally();
    progress.show(fmt::format("{:.1f} s   {} images, object in {}   {:+.2f} m/s", to_seconds(due.time_since_epoch()),
                              tally.frames, tally.found, tally.last_motion.commanded.forward_mps));
    if (!real_time) continue;
    // Time that was lost is not caught up: simulated time slows instead.
    not_before = std::max(not_before + mode_.frame_period, real_clock_.now());
    real_clock_.sleep_until(not_before);
  }
  stop.request();
  beats.advance_to(beats.last() + 2 * kMotionPeriod);
  motion.end();
  housekeeping_->step();
}

}  // namespace cgsr::robot
