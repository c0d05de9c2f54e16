#include "hal/sim/base/simulated_rmp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace cgsr::sim {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(1);
constexpr int kStepsPerServoFrame = 10;
constexpr Duration kCommandTimeout = std::chrono::milliseconds(400);
constexpr int kOffMessageEvery = 25;  // servo frames: every 250 ms while it is switched off
constexpr std::size_t kHistory = 1024;
constexpr double kMass_kg = 80.0;  // for the torques only
constexpr double kTwoPi = 6.283185307179586;
constexpr double kUiBattery_v = 6.325;
constexpr double kBaseBattery_v = 76.0;
constexpr std::uint16_t kController = 0x0005;
constexpr std::uint16_t kFirmwareBuild = 0x07F0;

enum Item : std::uint8_t {
  kMaxVelocity = 10,
  kMaxAcceleration = 11,
  kMaxTurn = 12,
  kGainSchedule = 13,
  kBalanceLockout = 15,
  kOperationalMode = 16,
  kResetIntegrators = 50,
};

}  // namespace

SimulatedRmp::SimulatedRmp(std::unique_ptr<hal::CanBus> bus, const BaseParameters& parameters,
                           const BasePlacement& placement, std::vector<BaseEvent> script)
    : bus_(std::move(bus)),
      parameters_(parameters),
      script_(std::move(script)),
      body_(parameters, placement.x_m, placement.y_m, placement.heading_rad, placement.seed),
      pitch_noise_(placement.seed ^ 0x5bd1e995U),
      begin_(placement.time),
      now_(placement.time),
      mode_(parameters.mode),
      history_(kHistory) {
  scales_.command_counts_per_degps = parameters.wire_turn_counts_per_degps;
  scales_.yaw_rate_positive_clockwise = parameters.wire_yaw_rate_clockwise;
  (void)bus_->start();  // a port fails to start only when it is started already
  switch_on();
  base_left_ = base_right_ = base_fore_aft_ = base_yaw_ = static_cast<std::uint32_t>(parameters.first_counts);
  servo_count_ = static_cast<std::uint16_t>(parameters.first_servo_count);
  aim();
  remember();
}

void SimulatedRmp::advance_to(MonoTime time) {
  const std::lock_guard lock(mutex_);
  while (now_ + kStep <= time) step();
}

BaseState SimulatedRmp::state_at(MonoTime time) {
  const std::lock_guard lock(mutex_);
  while (now_ + kStep <= time) step();
  const double since_begin = static_cast<double>((time - begin_).count()) / static_cast<double>(kStep.count());
  const auto last = static_cast<double>(remembered_ - 1);
  const double first = std::max(0.0, last - static_cast<double>(kHistory - 1));
  const double at = std::clamp(since_begin, first, last + 1.0);
  // Between two of the grid; past the last one onwards from the two before it: nothing happens between servo frames
  // that was not decided at the last one.
  const auto k = static_cast<std::uint64_t>(std::clamp(std::floor(at), first, std::max(first, last - 1.0)));
  const BaseState& a = history_[k % kHistory];
  const BaseState& b = history_[std::min(k + 1, remembered_ - 1) % kHistory];
  const double t = at - static_cast<double>(k);
  const auto between = [t](double from, double to) { return from + t * (to - from); };
  return {.stamp = begin_ + std::chrono::duration_cast<Duration>(at * kStep),
          .x_m = between(a.x_m, b.x_m),
          .y_m = between(a.y_m, b.y_m),
          .heading_rad = between(a.heading_rad, b.heading_rad),
          .pitch_rad = between(a.pitch_rad, b.pitch_rad),
          .pitch_rate_radps = between(a.pitch_rate_radps, b.pitch_rate_radps),
          .velocity = {.forward_mps = between(a.velocity.forward_mps, b.velocity.forward_mps),
                       .left_radps = between(a.velocity.left_radps, b.velocity.left_radps)}};
}

void SimulatedRmp::step() {
  body_.step(target_);
  now_ += kStep;
  ++steps_;
  remember();
  if (steps_ % kStepsPerServoFrame == 0) servo_frame();
}

void SimulatedRmp::servo_frame() {
  take_frames();
  const bool on = !shut_down_ && !troubled(BaseTrouble::kPowerOff);
  if (on && !powered_) switch_on();
  powered_ = on;
  aim();
  ++sets_;
  if (powered_) {
    ++servo_count_;
    send_set();
  } else if (sets_ % kOffMessageEvery == 0) {
    send(off_frame(kUiBattery_v));
  }
}

void SimulatedRmp::take_frames() {
  std::array<hal::CanFrame, 16> frames;
  for (std::size_t count = frames.size(); count == frames.size();) {
    count = bus_->receive(now_, frames);
    for (std::size_t i = 0; i < count; ++i) {
      if (!powered_) continue;
      if (is_shutdown(frames[i])) shut_down_ = true;
      if (const auto order = read_order(frames[i])) obey(*order);
    }
  }
}

void SimulatedRmp::obey(const Order& order) {
  order_ = order;
  order_at_ = now_;
  // Some hosts write a small parameter into both bytes: only the low one counts.
  if (order.item != 0) configure(order.item, order.value % 256);
}

void SimulatedRmp::configure(int item, int value) {
  switch (item) {
    case kMaxVelocity:
      settings_.max_velocity = std::min(value, 16);
      break;
    case kMaxAcceleration:
      settings_.max_acceleration = std::min(value, 16);
      break;
    case kMaxTurn:
      settings_.max_turn = std::min(value, 16);
      break;
    case kGainSchedule:
      settings_.gain_schedule = std::min(value, 2);
      break;
    case kBalanceLockout:
      settings_.balance_locked = value != 0;
      break;
    case kOperationalMode:
      if (value == 2 && settings_.balance_locked) break;
      if (value <= 3) mode_ = static_cast<BaseMode>(value);
      if (mode_ == BaseMode::kPowerDown) shut_down_ = true;
      break;
    case kResetIntegrators:
      if ((value & 1) != 0) base_right_ = 0, right_from_m_ = body_.right_way_m();
      if ((value & 2) != 0) base_left_ = 0, left_from_m_ = body_.left_way_m();
      if ((value & 4) != 0) base_yaw_ = 0, yaw_from_m_ = body_.right_way_m() - body_.left_way_m();
      if ((value & 8) != 0) base_fore_aft_ = 0, fore_aft_from_m_ = 0.5 * (body_.left_way_m() + body_.right_way_m());
      break;
    default:
      break;
  }
}

// From now to the next servo frame.
void SimulatedRmp::aim() {
  const bool moves = mode_ == BaseMode::kTractor || mode_ == BaseMode::kBalance;
  const bool stopped = troubled(BaseTrouble::kEmergencyStop) || troubled(BaseTrouble::kSafetyShutdown) ||
                       troubled(BaseTrouble::kMotorsOff);
  const bool commanded = order_at_ && now_ - *order_at_ < kCommandTimeout;
  target_.motors = powered_ && moves && !stopped;
  target_.balances = mode_ == BaseMode::kBalance;
  target_.max_acceleration_mps2 = parameters_.max_acceleration_mps2 * settings_.max_acceleration / 16.0;
  target_.velocity = {};
  if (!commanded) return;
  target_.velocity = {.forward_mps = order_.forward_mps(scales_) * settings_.max_velocity / 16.0,
                      .left_radps = order_.left_radps(scales_) * settings_.max_turn / 16.0};
}

void SimulatedRmp::send_set() {
  const double left_m = body_.left_way_m();
  const double right_m = body_.right_way_m();
  const double torque_nm = kMass_kg * body_.acceleration_mps2() * parameters_.axle_height_m / 2.0;
  const double noise_rad = parameters_.pitch_noise_rad * pitch_noise_.next();
  std::uint16_t word1 = target_.motors ? 0x0080 : 0;
  std::uint16_t word2 = 0;
  if (target_.motors && target_.balances) word1 |= 0x0100;
  if (troubled(BaseTrouble::kLowBattery)) word1 |= 0x4000;
  if (troubled(BaseTrouble::kSafetyShutdown)) word1 |= 0x0001;
  if (troubled(BaseTrouble::kEmergencyStop)) word2 |= 0x0002;
  for (const auto& event : script_) {
    if (event.trouble != BaseTrouble::kStatusBits || now_ < event.from || now_ >= event.to) continue;
    word1 |= event.word1;
    word2 |= event.word2;
  }

  send(motion_frame(scales_, body_.left_wheel_mps(), body_.right_wheel_mps(), body_.turn_radps(), servo_count_));
  send(wheels_frame(base_left_ + encoder_counts(left_m - left_from_m_, scales_.counts_per_m),
                    base_right_ + encoder_counts(right_m - right_from_m_, scales_.counts_per_m)));
  send(integrated_frame(
      base_fore_aft_ + encoder_counts(0.5 * (left_m + right_m) - fore_aft_from_m_, scales_.counts_per_m),
      base_yaw_ +
          encoder_counts((right_m - left_m - yaw_from_m_) / parameters_.track_m, scales_.counts_per_turn / kTwoPi)));
  if (sets_ % 20 == 0) send(unexplained_frame());
  send(torque_frame(scales_, torque_nm, torque_nm));
  send(power_frame(static_cast<int>(mode_), settings_.gain_schedule, kUiBattery_v, kBaseBattery_v));
  if (sets_ % 10 == 0) send(interface_frame(kUiBattery_v));
  send(echo_frame(order_));
  ticker_ = static_cast<std::uint16_t>(ticker_ + 2);
  send(build_frame(kFirmwareBuild, ticker_));
  send(attitude_frame(scales_, body_.pitch_rad() + noise_rad, body_.pitch_rate_radps(), 0.0, 0.0));
  send(status_frame(kController, word1, word2));
}

void SimulatedRmp::send(hal::CanFrame frame) {
  frame.stamp = now_;
  (void)bus_->send(frame);  // the base does not care whether anybody listens
}

void SimulatedRmp::switch_on() {
  mode_ = parameters_.mode;
  settings_ = {};
  order_ = {};
  order_at_.reset();
  servo_count_ = 0;
  base_left_ = base_right_ = base_fore_aft_ = base_yaw_ = 0;
  left_from_m_ = body_.left_way_m();
  right_from_m_ = body_.right_way_m();
  fore_aft_from_m_ = 0.5 * (left_from_m_ + right_from_m_);
  yaw_from_m_ = right_from_m_ - left_from_m_;
}

void SimulatedRmp::remember() {
  history_[remembered_++ % kHistory] = current();
}

bool SimulatedRmp::troubled(BaseTrouble trouble) const {
  return std::any_of(script_.begin(), script_.end(), [&](const BaseEvent& event) {
    return event.trouble == trouble && event.from <= now_ && now_ < event.to;
  });
}

BaseState SimulatedRmp::current() const {
  return {.stamp = now_,
          .x_m = body_.x_m(),
          .y_m = body_.y_m(),
          .heading_rad = body_.heading_rad(),
          .pitch_rad = body_.pitch_rad(),
          .pitch_rate_radps = body_.pitch_rate_radps(),
          .velocity = body_.velocity()};
}

}  // namespace cgsr::sim
