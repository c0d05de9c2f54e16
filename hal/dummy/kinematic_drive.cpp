#include "hal/dummy/kinematic_drive.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace cgsr::hal {
namespace {

constexpr Duration kGrid = std::chrono::milliseconds(1);
constexpr double kGrid_s = to_seconds(kGrid);

double approach(double value, double target, double most) {
  return value + std::clamp(target - value, -most, most);
}

}  // namespace

std::string_view to_string(DriveMood mood) {
  switch (mood) {
    case DriveMood::kWell:
      return "well";
    case DriveMood::kNotReady:
      return "not ready";
    case DriveMood::kSendFails:
      return "send fails";
    case DriveMood::kFeedbackStops:
      return "feedback stops";
  }
  return "";
}

Result<void> KinematicDrive::start() {
  if (started_) return fail("kinematic drive: started twice");
  started_ = true;
  on_grid_ = heard_any_ = false;
  state_ = heard_ = {};
  target_ = {};
  commanded_.store(false, std::memory_order_relaxed);
  return {};
}

tl::expected<void, DriveFailure> KinematicDrive::command(const Twist& twist, MonoTime now) {
  if (!started_) return tl::unexpected(DriveFailure::kNotStarted);
  advance(now);
  if (!std::isfinite(twist.forward_mps) || !std::isfinite(twist.left_radps)) {
    return tl::unexpected(DriveFailure::kSendFailed);
  }
  const DriveMood mood = mood_.load(std::memory_order_relaxed);
  if (mood == DriveMood::kNotReady) return tl::unexpected(DriveFailure::kNotReady);
  if (mood == DriveMood::kSendFails) return tl::unexpected(DriveFailure::kSendFailed);

  target_.forward_mps = std::clamp(twist.forward_mps, -parameters_.max_forward_mps, parameters_.max_forward_mps);
  target_.left_radps = std::clamp(twist.left_radps, -parameters_.max_turn_radps, parameters_.max_turn_radps);
  target_until_ = now + seconds(parameters_.command_timeout_s);
  last_forward_mps_.store(twist.forward_mps, std::memory_order_relaxed);
  last_left_radps_.store(twist.left_radps, std::memory_order_relaxed);
  commanded_.store(true, std::memory_order_release);
  return {};
}

tl::expected<Odometry, DriveFailure> KinematicDrive::odometry(MonoTime now) {
  if (!started_) return tl::unexpected(DriveFailure::kNotStarted);
  advance(now);
  const DriveMood mood = mood_.load(std::memory_order_relaxed);
  const bool hears = mood == DriveMood::kWell || mood == DriveMood::kNotReady;
  if (hears) {
    heard_ = state_;
    heard_any_ = true;
  }
  if (!heard_any_) return tl::unexpected(DriveFailure::kNoFeedback);
  return heard_;
}

void KinematicDrive::stop() {
  if (!started_) return;
  started_ = false;
  last_forward_mps_.store(0.0, std::memory_order_relaxed);
  last_left_radps_.store(0.0, std::memory_order_relaxed);
  commanded_.store(true, std::memory_order_release);
}

std::optional<Twist> KinematicDrive::last_command() const {
  if (!commanded_.load(std::memory_order_acquire)) return std::nullopt;
  return Twist{last_forward_mps_.load(std::memory_order_relaxed), last_left_radps_.load(std::memory_order_relaxed)};
}

bool KinematicDrive::stands_still() const {
  return state_.velocity.forward_mps == 0.0 && state_.velocity.left_radps == 0.0 && target_.forward_mps == 0.0 &&
         target_.left_radps == 0.0;
}

void KinematicDrive::advance(MonoTime now) {
  if (!on_grid_) {
    state_.stamp = MonoTime{now.time_since_epoch() / kGrid * kGrid};
    on_grid_ = true;
  }
  if (mood_.load(std::memory_order_relaxed) == DriveMood::kNotReady) target_ = {};
  while (state_.stamp + kGrid <= now) {
    if (state_.stamp >= target_until_) target_ = {};
    if (stands_still()) {  // hours of standing cost nothing
      state_.stamp += (now - state_.stamp) / kGrid * kGrid;
      return;
    }
    step();
  }
}

void KinematicDrive::step() {
  Twist& velocity = state_.velocity;
  const Twist before = velocity;
  velocity.forward_mps =
      approach(before.forward_mps, target_.forward_mps, parameters_.forward_acceleration_mps2 * kGrid_s);
  velocity.left_radps = approach(before.left_radps, target_.left_radps, parameters_.turn_acceleration_radps2 * kGrid_s);

  const double forward_m = 0.5 * (before.forward_mps + velocity.forward_mps) * kGrid_s;
  const double turn_rad = 0.5 * (before.left_radps + velocity.left_radps) * kGrid_s;
  const double heading_rad = state_.heading_rad + 0.5 * turn_rad;
  state_.x_m += forward_m * std::cos(heading_rad);
  state_.y_m += forward_m * std::sin(heading_rad);
  state_.heading_rad += turn_rad;
  state_.stamp += kGrid;
}

}  // namespace cgsr::hal
