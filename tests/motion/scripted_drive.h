#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "hal/drive.h"
#include "hal/fault_latch.h"

namespace cgsr {

/// A base that does what a test tells it to do or to fail at; without delay and inertia unless the test wants them. Commands
/// are kept for the test to look at.
class ScriptedDrive : public hal::Drive {
 public:
  struct Script {
    bool sends = true;          ///< commands leave the computer.
    int sends_fail_next = 0;    ///< so many commands fail, then they leave again.
    bool ready = true;          ///< the base accepts motion.
    bool reports = true;        ///< odometry is answered at all.
    bool measures = true;       ///< odometry's stamp moves on.
    bool finite = true;         ///< odometry is a number.
    bool finite_speed = true;   ///< the speeds in it too.
    bool from_the_past = true;  ///< odometry's stamp is not in the future.
  };

  ScriptedDrive() {
    commands.reserve(50000);
    times.reserve(50000);
  }

  Result<void> start() override {
    ++starts;
    return {};
  }

  tl::expected<void, hal::DriveFailure> command(const hal::Twist& twist, MonoTime now) override {
    advance(now);
    if (!script.ready) return tl::unexpected(hal::DriveFailure::kNotReady);
    if (!script.sends) return tl::unexpected(hal::DriveFailure::kSendFailed);
    if (script.sends_fail_next-- > 0) return tl::unexpected(hal::DriveFailure::kSendFailed);
    commands.push_back(twist);
    times.push_back(now);
    obey(now);
    return {};
  }

  tl::expected<hal::Odometry, hal::DriveFailure> odometry(MonoTime now) override {
    if (!script.reports) return tl::unexpected(hal::DriveFailure::kNoFeedback);
    advance(now);
    if (script.measures) {
      heard = truth;
      heard.stamp = script.from_the_past ? now : now + seconds(0.001);
    }
    auto answer = heard;
    if (!script.finite_speed) answer.velocity.left_radps = std::numeric_limits<double>::infinity();
    if (!script.finite) answer.heading_rad = std::numeric_limits<double>::quiet_NaN();
    return answer;
  }

  void stop() override {
    ++stops;
    truth.velocity = target_ = {};
  }

  Script script;
  hal::Odometry truth;                                            ///< where it really is, and how fast.
  hal::Odometry heard;                                            ///< what it reported last.
  Duration delay{};                                               ///< from a command to obeying it.
  double inertia_mps2 = std::numeric_limits<double>::infinity();  ///< how fast the speed changes at most.
  std::vector<hal::Twist> commands;
  std::vector<MonoTime> times;  ///< of the commands.
  int starts = 0;
  int stops = 0;

 private:
  void advance(MonoTime now) {
    constexpr Duration kStep = seconds(0.001);
    while (truth.stamp < now) {
      // Nothing moves before the first command, so that time may start anywhere.
      const MonoTime until = commands.empty() ? now : std::min(now, truth.stamp + kStep);
      obey(truth.stamp);
      const double elapsed_s = to_seconds(until - truth.stamp);
      const double middle_rad = truth.heading_rad + 0.5 * truth.velocity.left_radps * elapsed_s;
      truth.x_m += truth.velocity.forward_mps * std::cos(middle_rad) * elapsed_s;
      truth.y_m += truth.velocity.forward_mps * std::sin(middle_rad) * elapsed_s;
      truth.heading_rad += truth.velocity.left_radps * elapsed_s;
      truth.stamp = until;
    }
  }

  /// Takes over what is due; the speed follows within the inertia.
  void obey(MonoTime now) {
    while (obeyed_ < commands.size() && times[obeyed_] + delay <= now) target_ = commands[obeyed_++];
    const double change = target_.forward_mps - truth.velocity.forward_mps;
    const double most = inertia_mps2 * 0.001;
    truth.velocity.forward_mps += std::clamp(change, -most, most);
    truth.velocity.left_radps = target_.left_radps;
  }

  std::size_t obeyed_ = 0;
  hal::Twist target_;
};

/// The same with faults of its own that latch.
class LatchingDrive final : public ScriptedDrive, public hal::FaultLatch {
 public:
  tl::expected<void, hal::DriveFailure> command(const hal::Twist& twist, MonoTime now) override {
    const bool moves = twist.forward_mps != 0.0 || twist.left_radps != 0.0;
    if (standing != hal::DriveFault::kNone || (moves && latched != hal::DriveFault::kNone)) {
      return tl::unexpected(hal::DriveFailure::kNotReady);
    }
    return ScriptedDrive::command(twist, now);
  }
  [[nodiscard]] hal::DriveFault fault() const override {
    return standing != hal::DriveFault::kNone ? standing : latched;
  }
  tl::expected<void, hal::DriveFault> rearm(MonoTime) override {
    ++rearms;
    if (standing != hal::DriveFault::kNone) return tl::unexpected(standing);
    latched = hal::DriveFault::kNone;
    return {};
  }

  hal::DriveFault standing = hal::DriveFault::kNone;
  hal::DriveFault latched = hal::DriveFault::kNone;
  int rearms = 0;
};

}  // namespace cgsr
