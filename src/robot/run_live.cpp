#include <optional>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "pipeline/runtime/robot_threads.h"
#include "platform/memory.h"
#include "platform/service.h"
#include "platform/thread.h"
#include "src/output/progress.h"
#include "src/robot/capture_task.h"
#include "src/robot/motion_task.h"
#include "src/robot/robot.h"
#include "src/robot/switch_task.h"
#include "src/robot/vision_task.h"

namespace cgsr::robot {
namespace {

constexpr Duration kSupervisorPeriod = seconds(0.1);
constexpr Duration kHousekeepingPeriod = seconds(0.01);

/// The bodies of the threads of docs/threads.md: each a task and the wait between its steps.
class LiveLoops {
 public:
  LiveLoops(CaptureTask& capture, VisionTask& vision, MotionTask& motion, SwitchTask& switches,
            HousekeepingTask& housekeeping, RealClock& clock, StopRequest& stop, Links& links)
      : capture_(capture),
        vision_(vision),
        motion_(motion),
        switches_(switches),
        housekeeping_(housekeeping),
        clock_(clock),
        stop_(stop),
        links_(links) {
    const MonoTime now = clock.now();
    capture_beat_ = heartbeats.add("capture", 3 * capture.period() + seconds(0.5), now);
    vision_beat_ = heartbeats.add("vision", 3 * capture.period() + seconds(0.5), now);
    motion_beat_ = heartbeats.add("motion", seconds(0.2), now);
  }

  void capture() {
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
    Periodic beat(clock_, kMotionPeriod);
    while (!stop_.requested()) {
      beat.wait();
      motion_.step(clock_.now());
      heartbeats.beat(motion_beat_, clock_.now());
    }
    motion_.step(clock_.now());
    motion_.end();
  }

  void switches() {
    Periodic look(clock_, kSwitchPeriod);
    while (!stop_.requested()) {
      look.wait();
      if (const auto problem = switches_.step()) spdlog::error("switches: {}", *problem);
    }
  }

  void housekeeping() {
    Periodic round(clock_, kHousekeepingPeriod);
    while (!stop_.requested()) {
      round.wait();
      housekeeping_.step();
    }
  }

  Heartbeats heartbeats;

 private:
  CaptureTask& capture_;
  VisionTask& vision_;
  MotionTask& motion_;
  SwitchTask& switches_;
  HousekeepingTask& housekeeping_;
  RealClock& clock_;
  StopRequest& stop_;
  Links& links_;
  std::size_t capture_beat_ = 0;
  std::size_t vision_beat_ = 0;
  std::size_t motion_beat_ = 0;
};

Result<void> start_threads(ThreadTable& threads, LiveLoops& loops, Links& links) {
  const auto start = [&threads](const ThreadSpec& spec, auto body, WakeUp* wake = nullptr) {
    return threads.start(spec, body, wake);
  };
  // Consumers before producers: whoever gets work is there to take it.
  if (auto done = start(runtime::kMotionThread, [&loops] { loops.motion(); }); !done) return done;
  if (auto done = start(runtime::kHousekeepingThread, [&loops] { loops.housekeeping(); }); !done) return done;
  if (auto done = start(runtime::kSwitchThread, [&loops] { loops.switches(); }); !done) return done;
  if (auto done = start(
          runtime::kVisionThread, [&loops] { loops.vision(); }, &links.image_came);
      !done)
    return done;
  return start(runtime::kCaptureThread, [&loops] { loops.capture(); });
}

}  // namespace

Result<void> Robot::run_live(StopRequest& stop) {
  spdlog::info("memory: {}", lock_memory().text);
  CaptureTask capture(*camera_, mode_.frame_period, links_);
  VisionTask vision(*vision_, *runner_, real_clock_, mode_.frame_period, links_);
  MotionTask motion(*motion_, stop, Duration::zero(), options_.arm, links_);
  SwitchTask switches(*switches_, lines(), real_clock_, links_);
  LiveLoops loops(capture, vision, motion, switches, *housekeeping_, real_clock_, stop, links_);

  ThreadTable threads(stop);
  if (auto started = start_threads(threads, loops, links_); !started) return started;
  spdlog::info("threads:\n{}", to_text(threads.report()));
  service::notify_ready();

  const MonoTime begin = real_clock_.now();
  const MonoTime end = options_.duration_s > 0.0 ? begin + seconds(options_.duration_s) : MonoTime::max();
  bool silence_told = false;
  while (!stop.wait_until(std::min(end, real_clock_.now() + kSupervisorPeriod))) {
    if (real_clock_.now() >= end) break;
    const auto silent = supervise(loops.heartbeats, real_clock_.now());
    if (!silent.empty() && !silence_told) {
      spdlog::critical("thread {} silent for {:.1f} s: the watchdog is not pinged", silent.front().name,
                       to_seconds(silent.front().lasting));
    }
    silence_told = !silent.empty();
  }
  service::notify_stopping();
  Result<void> outcome = camera_outcome();
  camera_->stop();
  threads.stop_and_join();
  housekeeping_->step();
  return outcome;
}

}  // namespace cgsr::robot
