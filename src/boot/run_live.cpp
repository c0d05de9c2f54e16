#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "pipeline/runtime/robot_threads.h"
#include "platform/memory.h"
#include "platform/message_rate.h"
#include "platform/service.h"
#include "platform/thread.h"
#include "src/boot/run_loops.h"
#include "src/tasks/capture_task.h"
#include "src/tasks/motion_task.h"
#include "src/tasks/recognition_task.h"

namespace cgsr::boot {
namespace {

constexpr Duration kSupervisorPeriod = seconds(0.1);
constexpr Duration kHousekeepingPeriod = seconds(0.01);
constexpr Duration kRecognitionPeriod = seconds(0.1);  // in which it looks whether it is to stop
constexpr Duration kCameraMessageGap = seconds(5.0);

/// The bodies of the threads of docs/threads.md: each a task and the wait between its steps.
class LiveLoops {
 public:
  LiveLoops(tasks::CaptureTask& capture, tasks::VisionTask& vision, tasks::MotionTask& motion,
            tasks::SwitchTask& switches, tasks::RecognitionTask* recognition, tasks::HousekeepingTask& housekeeping,
            RobotState& state, StopRequest& stop)
      : capture_(capture),
        vision_(vision),
        motion_(motion),
        switches_(switches),
        recognition_(recognition),
        housekeeping_(housekeeping),
        devices_(state.devices),
        real_camera_(state.setup.config.real_camera()),
        clock_(state.clocks.real),
        stop_(stop),
        links_(state.links) {
    const MonoTime now = clock_.now();
    capture_beat_ = heartbeats.add("capture", 3 * capture.period() + seconds(0.5), now);
    vision_beat_ = heartbeats.add("vision", 3 * capture.period() + seconds(0.5), now);
    motion_beat_ = heartbeats.add("motion", seconds(0.2), now);
    // An arming line that hangs has to be noticed. Lamps are switched in the same step as it is read: one whose driver hangs
    // costs the mask, and where there is an arming line it also stops and disarms the robot.
    if (!state.lines().arming.empty()) {
      switch_beat_ = heartbeats.add("switches", tasks::kMaxArmingReportAge, now);
    }
  }

  void capture() {
    // Since the first image the computer was busy with memory and threads, for about 0.2 s at 1 GHz, and the camera streamed.
    if (real_camera_) static_cast<void>(capture_.pass_over_waiting(clock_));
    while (!stop_.requested()) {
      const bool more = capture_.step(clock_.now() + capture_.period() + capture_.period() / 2);
      heartbeats.beat(capture_beat_, clock_.now());
      if (!more) return stop_.request();
    }
  }

  void vision() {
    while (!stop_.requested()) {
      const MonoTime give_up_at = clock_.now() + capture_.period() + capture_.period() / 2;
      const bool woken = links_.image_came.wait_until(give_up_at);
      if (stop_.requested()) return;
      if (woken) {
        vision_.step();
      } else {
        vision_.step_without_image(clock_.now());
      }
      heartbeats.beat(vision_beat_, clock_.now());
    }
  }

  void motion() {
    Periodic cycle(clock_, kMotionPeriod);
    while (!stop_.requested()) {
      cycle.wait();
      motion_.step(clock_.now());
      heartbeats.beat(motion_beat_, clock_.now());
    }
    motion_.step(clock_.now());
    motion_.end();
  }

  void switches() {
    Periodic look(clock_, tasks::kSwitchPeriod);
    while (!stop_.requested()) {
      look.wait();
      advance_simulation();
      if (const auto news = switches_.step()) spdlog::warn("switches: {}", *news);
      if (switch_beat_) heartbeats.beat(*switch_beat_, clock_.now());
    }
  }

  void recognition() {
    while (!stop_.requested()) {
      static_cast<void>(links_.face_question_came.wait_until(clock_.now() + kRecognitionPeriod));
      recognition_->step();
    }
  }

  void housekeeping() {
    Periodic round(clock_, kHousekeepingPeriod);
    while (!stop_.requested()) {
      round.wait();
      housekeeping_.step(clock_.now());
    }
  }

  [[nodiscard]] bool identifies() const { return recognition_ != nullptr; }

  Heartbeats heartbeats;

 private:
  /// The simulated home's lines belong to the thread that uses them; its base follows its bus.
  void advance_simulation() {
    if (devices_.simulation == nullptr) return;
    devices_.simulation->advance_to(MonoTime{clock_.now() - devices_.simulation_origin});
  }

  tasks::CaptureTask& capture_;
  tasks::VisionTask& vision_;
  tasks::MotionTask& motion_;
  tasks::SwitchTask& switches_;
  tasks::RecognitionTask* recognition_;  // null: nobody is to be identified
  tasks::HousekeepingTask& housekeeping_;
  Devices& devices_;
  bool real_camera_;
  RealClock& clock_;
  StopRequest& stop_;
  tasks::Links& links_;
  std::size_t capture_beat_ = 0;
  std::size_t vision_beat_ = 0;
  std::size_t motion_beat_ = 0;
  std::optional<std::size_t> switch_beat_;  // none: there is no arming line
};

Result<void> start_threads(ThreadTable& threads, LiveLoops& loops, tasks::Links& links) {
  const auto start = [&threads](const ThreadSpec& spec, auto body, WakeUp* wake = nullptr) {
    return threads.start(spec, body, wake);
  };
  // Consumers before producers: whoever gets work is there to take it.
  if (auto done = start(runtime::kMotionThread, [&loops] { loops.motion(); }); !done) return done;
  if (auto done = start(runtime::kHousekeepingThread, [&loops] { loops.housekeeping(); }); !done) return done;
  if (loops.identifies()) {
    auto done = start(
        runtime::kRecognitionThread, [&loops] { loops.recognition(); }, &links.face_question_came);
    if (!done) return done;
  }
  if (auto done = start(runtime::kSwitchThread, [&loops] { loops.switches(); }); !done) return done;
  if (auto done = start(
          runtime::kVisionThread, [&loops] { loops.vision(); }, &links.image_came);
      !done)
    return done;
  return start(runtime::kCaptureThread, [&loops] { loops.capture(); });
}

/// Names each thread that falls silent once, until it is heard again.
class SilenceLog {
 public:
  void take(const std::vector<Heartbeats::Silence>& silent) {
    for (const auto& [name, lasting] : silent) {
      if (std::find(named_.begin(), named_.end(), name) != named_.end()) continue;
      spdlog::critical("thread {} silent for {:.1f} s: the watchdog is not pinged", name, to_seconds(lasting));
    }
    named_.clear();
    for (const auto& thread : silent) named_.push_back(thread.name);
  }

 private:
  std::vector<std::string_view> named_;
};

/// Until somebody requests a stop or the end comes. A thread that is silent is named once, and the watchdog is not pinged.
/// What the camera says of itself (unplugged, back, damaged images) goes to the log, a line in kCameraMessageGap at most.
void supervise_until(MonoTime end, Heartbeats& heartbeats, const hal::Camera& camera, RealClock& clock,
                     StopRequest& stop) {
  SilenceLog silences;
  MessageRate camera_messages(kCameraMessageGap);
  while (!stop.wait_until(std::min(end, clock.now() + kSupervisorPeriod))) {
    if (clock.now() >= end) break;
    silences.take(supervise(heartbeats, clock.now()));
    const std::string problem = camera.last_problem();
    if (camera_messages.take(problem, clock.now())) {
      spdlog::warn("{}", problem);
      service::notify_status(problem);
    }
  }
}

}  // namespace

Result<void> run_live(RobotState& state, StopRequest& stop) {
  spdlog::info("memory: {}", lock_memory().text);
  const Duration period = state.devices.mode.frame_period;
  RealClock& clock = state.clocks.real;
  tasks::CaptureTask capture(*state.devices.camera, period, state.links);
  tasks::VisionTask vision(*state.vision.loop, *state.vision.runner, state.surroundings(), clock, period, state.links);
  tasks::MotionTask motion(*state.devices.base, stop, Duration::zero(), state.setup.options.arm, state.links);
  tasks::SwitchTask switches(*state.devices.switches, state.lines(), clock, state.links);
  tasks::HousekeepingTask housekeeping(state.links, state.outputs.sinks);
  std::optional<tasks::RecognitionTask> recognition;
  if (state.vision.people) recognition.emplace(std::move(*state.vision.people), state.links);
  state.vision.people.reset();
  LiveLoops loops(capture, vision, motion, switches, recognition ? &*recognition : nullptr, housekeeping, state, stop);

  ThreadTable threads(stop);
  if (auto started = start_threads(threads, loops, state.links); !started) return started;
  spdlog::info("threads:\n{}", to_text(threads.report()));
  service::notify_ready();
  service::notify_status("running");

  const double duration_s = state.setup.options.duration_s;
  supervise_until(duration_s > 0.0 ? clock.now() + seconds(duration_s) : MonoTime::max(), loops.heartbeats,
                  *state.devices.camera, clock, stop);
  service::notify_stopping();
  Result<void> outcome = camera_outcome(state);
  state.devices.camera->stop();
  threads.stop_and_join();
  housekeeping.step(clock.now());
  return outcome;
}

}  // namespace cgsr::boot
