#include "hal/rmp/listener.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <variant>

#include "hal/rmp/codec.h"

namespace cgsr::hal::rmp {
namespace {

constexpr int kMostLostSets = 1000;  // more is not a loss but another count
constexpr double kMostPitchRad = 1.6;

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

}  // namespace

DriveFault reported_fault(const RmpReport& report) {
  const auto any1 = [&report](unsigned bits) { return (report.status.word1 & bits) != 0; };
  const auto any2 = [&report](unsigned bits) { return (report.status.word2 & bits) != 0; };
  const auto mode = report.power.mode;
  if (any2(word2::kEmergencyStop)) return DriveFault::kEmergencyStop;
  if (any1(word1::kSafetyShutdown)) return DriveFault::kSafetyShutdown;
  if (any1(word1::kIntegrityFault | word1::kSpeedLimitedToZero) || any2(word2::kFault)) return DriveFault::kBaseFault;
  if (any1(word1::kLowBattery | word1::kEmptyBattery) || any2(word2::kEmptyBattery)) return DriveFault::kLowBattery;
  if (!any1(word1::kMotorsEnabled)) return DriveFault::kMotorsOff;
  if (mode != OperationalMode::kTractor && mode != OperationalMode::kBalance) return DriveFault::kMotorsOff;
  return DriveFault::kNone;
}

Listener::Listener(const RmpParameters& parameters)
    : parameters_(parameters),
      age_(seconds(parameters.feedback_warn_s)),
      odometer_(parameters.scales, parameters.max_plausible_mps, parameters.max_plausible_radps) {}

void Listener::take(const CanFrame& frame, MonoTime stamp) {
  const auto message = decode(frame);
  if (!message) {
    ++counters_.undecodable;
    return;
  }
  std::visit(Overloaded{[&](const Motion& motion) { take_motion(motion, stamp); },
                        [&](const Integrated& integrated) { take_integrated(integrated, stamp); },
                        [&](const Attitude& attitude) { take_attitude(attitude, stamp); },
                        [&](const Echo& echo) { check_echo(echo); },
                        [&](const ModeAndPower& power) {
                          report_.power = power;
                          fresh(MessageId::kModeAndPower, stamp);
                        },
                        [&](const Status& status) {
                          report_.status = status;
                          fresh(MessageId::kStatus, stamp);
                        },
                        [&](const Build& build) { report_.firmware_build = build.build; },
                        [&](const Command&) {  // a bus never hands out its own node's frames
                          ++counters_.foreign_commands;
                          foreign_command_at_ = stamp;
                        },
                        [&](const Shutdown&) { powered_off_at_ = stamp; }, [](const auto&) {}},
             *message);
}

void Listener::said(const Command& command) {
  said_[said_count_++ % said_.size()] = command;
}

bool Listener::stale(MonoTime now) {
  const auto oldest = age_.oldest(now);
  const bool late = oldest && oldest->age > seconds(parameters_.feedback_warn_s);
  const bool stale = oldest && oldest->age > seconds(parameters_.feedback_timeout_s);
  if (late && !late_) ++counters_.late;
  if (stale && !stale_) ++counters_.stale;
  late_ = late;
  stale_ = stale;
  return stale;
}

void Listener::take_motion(const Motion& motion, MonoTime stamp) {
  const auto velocity = to_twist(motion, parameters_.scales);
  const int fastest_wheel = std::max(std::abs(motion.left), std::abs(motion.right));
  if (fastest_wheel > parameters_.max_plausible_mps * parameters_.scales.velocity_per_mps ||
      std::abs(velocity.left_radps) > parameters_.max_plausible_radps) {
    ++counters_.implausible;
    return;
  }
  if (motion_) {
    const int frames = static_cast<std::uint16_t>(motion.servo_frame - motion_->servo_frame);
    if (frames > 1 && frames <= kMostLostSets) counters_.lost_sets += static_cast<unsigned>(frames - 1);
  }
  motion_ = motion;
  yaw_check_.take(motion, parameters_.scales);
  odometry_.velocity = velocity;
  fresh(MessageId::kMotion, stamp);
}

void Listener::take_integrated(const Integrated& integrated, MonoTime stamp) {
  if (!motion_) return;  // without a count of servo frames a difference cannot be judged
  switch (odometer_.take(integrated, motion_->servo_frame)) {
    case Odometer::Outcome::kJump:
      ++counters_.jumps;
      return;
    case Odometer::Outcome::kNewBaseline:
      ++counters_.new_baselines;
      break;
    case Odometer::Outcome::kBaseline:
    case Odometer::Outcome::kTravelled:
      break;
  }
  odometry_.stamp = stamp;
  odometry_.x_m = odometer_.pose().x_m;
  odometry_.y_m = odometer_.pose().y_m;
  odometry_.heading_rad = odometer_.pose().heading_rad;
  fresh(MessageId::kIntegrated, stamp);
}

void Listener::take_attitude(const Attitude& attitude, MonoTime stamp) {
  const double pitch = pitch_rad(attitude, parameters_.scales);
  if (std::abs(pitch) > kMostPitchRad) {
    ++counters_.implausible;
    return;
  }
  odometry_.pitch_rad = pitch;
  fresh(MessageId::kAttitude, stamp);
}

void Listener::check_echo(const Echo& echo) {
  // Until as many were said as are remembered, the echo may rightly be of something older.
  if (said_count_ < said_.size()) return;
  const bool known = std::any_of(said_.begin(), said_.end(), [&echo](const Command& said) {
    return said.velocity == echo.velocity && said.turn == echo.turn;
  });
  if (!known) ++counters_.echo_mismatches;
}

void Listener::fresh(MessageId id, MonoTime stamp) {
  if (age_.take(id, stamp)) ++counters_.sets;
}

}  // namespace cgsr::hal::rmp
