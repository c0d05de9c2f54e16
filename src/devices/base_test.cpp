#include "src/devices/base_test.h"

#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "hal/rmp/scales.h"

namespace cgsr::devices {
namespace {

constexpr Duration kCycle = seconds(0.010);
constexpr Duration kPrintEvery = seconds(0.5);
constexpr double kCatchUp_s = 0.5;
constexpr double kDegrees = 180.0 / std::numbers::pi;

class BaseTest {
 public:
  BaseTest(hal::rmp::RmpDrive& drive, const hal::rmp::RmpParameters& parameters, Clock& clock,
           const BaseTestOptions& options, const BaseTestObserver& observer)
      : drive_(drive), parameters_(parameters), clock_(clock), options_(options), observer_(observer) {}

  Result<void> run() {
    began_ = clock_.now();
    const auto heard = cycle(options_.listen_s, std::nullopt);
    if (!heard) {
      return fail(fmt::format("nothing complete was heard of the base: {}", hal::to_string(drive_.fault())));
    }
    print_counters();
    if (!options_.arm) return {};
    if (drive_.fault() != hal::DriveFault::kNone) {
      return fail(fmt::format("the base cannot move: {}", hal::to_string(drive_.fault())));
    }
    if (!observer_.confirm()) {
      observer_.print("not confirmed: the base was not moved");
      return {};
    }
    return move();
  }

 private:
  /// Cycles for `duration_s`. \param command  nothing: only listens. \return the last odometry.
  std::optional<hal::Odometry> cycle(double duration_s, const std::optional<hal::Twist>& command) {
    std::optional<hal::Odometry> last;
    Periodic period(clock_, kCycle);
    const MonoTime end = clock_.now() + seconds(duration_s);
    while (clock_.now() < end && !observer_.stop_requested()) {
      const MonoTime now = period.wait();
      if (command) static_cast<void>(drive_.command(*command, now));
      if (const auto odometry = drive_.odometry(now)) last = *odometry;
      if (now >= print_at_) {
        print_state(now, last);
        print_at_ = now + kPrintEvery;
      }
    }
    return last;
  }

  void print_state(MonoTime now, const std::optional<hal::Odometry>& odometry) {
    const auto& report = drive_.report();
    std::string line = fmt::format("{:6.1f} s  ", to_seconds(now - began_));
    if (odometry) {
      line += fmt::format(
          "x {:+.3f} m  y {:+.3f} m  heading {:+.1f} deg  {:+.2f} m/s  {:+.1f} deg/s  pitch {:+.1f} deg  "
          "battery {:.1f} V  ",
          odometry->x_m, odometry->y_m, kDegrees * odometry->heading_rad, odometry->velocity.forward_mps,
          kDegrees * odometry->velocity.left_radps, kDegrees * odometry->pitch_rad,
          hal::rmp::base_battery_v(report.power, parameters_.scales));
    }
    const auto mode = to_string(report.power.mode);
    observer_.print(line +
                    fmt::format("mode {}  fault: {}", mode.empty() ? "unknown" : mode, hal::to_string(drive_.fault())));
  }

  void print_counters() {
    const auto counters = drive_.counters();
    observer_.print(
        fmt::format("{} whole sets of feedback, {} lost, {} implausible messages, {} commands of others, {} "
                    "frames of another family; firmware build 0x{:04X}",
                    counters.feedback.sets, counters.feedback.lost_sets, counters.feedback.implausible,
                    counters.feedback.foreign_commands, counters.feedback.undecodable, drive_.report().firmware_build));
  }

  Result<void> move() {
    // Nobody read the bus while somebody was asked: what waits there is old, and the newest did not fit.
    cycle(kCatchUp_s, std::nullopt);
    if (const auto armed = drive_.rearm(clock_.now()); !armed) {
      return fail(fmt::format("the base cannot be armed: {}", hal::to_string(armed.error())));
    }
    const auto forward = movement({options_.forward_mps, 0.0});
    if (!forward) return tl::unexpected(forward.error());
    const auto left = movement({0.0, options_.left_radps});
    if (!left) return tl::unexpected(left.error());
    observer_.print(fmt::format("forward: {:+.3f} m of {:+.3f} m    left: {:+.1f} deg of {:+.1f} deg", forward->x_m,
                                options_.forward_mps * options_.move_s, kDegrees * left->heading_rad,
                                kDegrees * options_.left_radps * options_.move_s));
    if (forward->x_m <= 0.0) return fail("the base did not move forward, or reports it as backward");
    if (left->heading_rad <= 0.0) return fail("the base did not turn left, or reports it as right");
    return {};
  }

  /// \return how far the base came, x along its heading before.
  Result<hal::Odometry> movement(const hal::Twist& twist) {
    const auto before = cycle(0.1, hal::Twist{});
    const auto during = cycle(options_.move_s, twist);
    const auto after = cycle(1.0, hal::Twist{});
    if (drive_.fault() != hal::DriveFault::kNone) {
      return fail(fmt::format("the base stopped: {}", hal::to_string(drive_.fault())));
    }
    if (observer_.stop_requested()) return fail("ended by a signal; the base stands");
    if (!before || !during || !after) return fail("the base fell silent");
    hal::Odometry moved;
    moved.x_m = (after->x_m - before->x_m) * std::cos(before->heading_rad) +
                (after->y_m - before->y_m) * std::sin(before->heading_rad);
    moved.heading_rad = after->heading_rad - before->heading_rad;
    return moved;
  }

  hal::rmp::RmpDrive& drive_;
  const hal::rmp::RmpParameters& parameters_;
  Clock& clock_;
  const BaseTestOptions& options_;
  const BaseTestObserver& observer_;
  MonoTime began_{};
  MonoTime print_at_{};
};

}  // namespace

Result<void> test_base(hal::rmp::RmpDrive& drive, const hal::rmp::RmpParameters& parameters, Clock& clock,
                       const BaseTestOptions& options, const BaseTestObserver& observer) {
  if (auto started = drive.start(); !started) return started;
  auto outcome = BaseTest(drive, parameters, clock, options, observer).run();
  drive.stop();
  return outcome;
}

}  // namespace cgsr::devices
