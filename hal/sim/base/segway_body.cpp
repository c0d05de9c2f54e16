#include "hal/sim/base/segway_body.h"

#include <algorithm>
#include <cmath>

namespace cgsr::sim {
namespace {

constexpr double kGravity = 9.81;
constexpr double kLongestTurn = 1.0 / 128.0;  // the series below is good to the last bit up to here
constexpr double kStandUp_s = 0.15;           // how fast it comes upright when it does not balance

// Towards `target` with time constant `lag_s`, at most `limit` per second.
double approach(double value, double target, double lag_s, double limit, double dt_s) {
  return value + std::clamp((target - value) / lag_s, -limit, limit) * dt_s;
}

}  // namespace

void Direction::turn(double left_rad) {
  while (left_rad != 0.0) {
    const double a = std::clamp(left_rad, -kLongestTurn, kLongestTurn);
    left_rad -= a;
    const double aa = a * a;
    const double sine = a * (1.0 - aa / 6.0 * (1.0 - aa / 20.0 * (1.0 - aa / 42.0)));
    const double cosine = 1.0 - aa / 2.0 * (1.0 - aa / 12.0 * (1.0 - aa / 30.0 * (1.0 - aa / 56.0)));
    const double turned = cosine * x - sine * y;
    y = sine * x + cosine * y;
    x = turned;
    const double to_unit = 1.5 - 0.5 * (x * x + y * y);  // a Newton step: rounding must not pile up
    x *= to_unit;
    y *= to_unit;
  }
}

double Noise::next() {
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) {  // splitmix64
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
    sum += static_cast<double>(z >> 11) * 0x1.0p-53;
  }
  return sum - 6.0;
}

SegwayBody::SegwayBody(const BaseParameters& parameters, double x_m, double y_m, double heading_rad, std::uint64_t seed)
    : p_(parameters), noise_(seed), x_m_(x_m), y_m_(y_m), heading_rad_(heading_rad) {
  direction_.turn(heading_rad);
}

void SegwayBody::step(const BodyTarget& target) {
  const double speed_before = speed_mps_;
  if (target.motors) {
    drive(target);
  } else {
    roll_out();
  }
  acceleration_mps2_ = (speed_mps_ - speed_before) / kStep_s;
  roll();
}

void SegwayBody::drive(const BodyTarget& target) {
  wanted_mps_ =
      approach(wanted_mps_, target.velocity.forward_mps, p_.velocity_lag_s, target.max_acceleration_mps2, kStep_s);
  smooth_mps_ += (wanted_mps_ - smooth_mps_) * (kStep_s / p_.velocity_lag_s);
  if (target.balances) {
    const double w = p_.balance_rate_radps;
    pitch_rate_radps_ = w * w * (smooth_mps_ / kGravity - lean_s_) - 2.0 * p_.balance_damping * w * pitch_rad_;
    pitch_rad_ += pitch_rate_radps_ * kStep_s;
    lean_s_ += pitch_rad_ * kStep_s;
    speed_mps_ = kGravity * lean_s_ - p_.pendulum_length_m * pitch_rate_radps_;
  } else {
    pitch_rate_radps_ = -pitch_rad_ / kStandUp_s;
    pitch_rad_ += pitch_rate_radps_ * kStep_s;
    speed_mps_ = smooth_mps_;
    lean_s_ = speed_mps_ / kGravity;
  }
  const double speed = std::abs(speed_mps_);
  const double turn = target.velocity.left_radps * (speed > p_.turn_knee_mps ? p_.turn_knee_mps / speed : 1.0);
  turn_radps_ = approach(turn_radps_, turn, p_.turn_lag_s, p_.max_turn_acceleration_radps2, kStep_s);
}

void SegwayBody::roll_out() {
  const double slower = p_.brake_mps2 * kStep_s;
  const double turn_slower = slower / (0.5 * p_.track_m);
  speed_mps_ -= std::clamp(speed_mps_, -slower, slower);
  turn_radps_ -= std::clamp(turn_radps_, -turn_slower, turn_slower);
  pitch_rate_radps_ = -pitch_rad_ / kStandUp_s;
  pitch_rad_ += pitch_rate_radps_ * kStep_s;
  // So that the motors, when they come back, take over from here without a jolt.
  wanted_mps_ = smooth_mps_ = speed_mps_;
  lean_s_ = speed_mps_ / kGravity;
}

void SegwayBody::roll() {
  const double forget = kStep_s / p_.slip_time_s;
  const double shake = p_.slip * std::sqrt(2.0 * forget);
  left_slip_ += -forget * left_slip_ + shake * noise_.next();
  right_slip_ += -forget * right_slip_ + shake * noise_.next();

  const double left = left_wheel_mps();
  const double right = right_wheel_mps();
  left_way_m_ += left * kStep_s;
  right_way_m_ += right * kStep_s;

  const double left_ground = left * (1.0 - left_slip_);
  const double right_ground = right * (1.0 - right_slip_);
  over_ground_ = {.forward_mps = 0.5 * (left_ground + right_ground),
                  .left_radps = (1.0 - p_.turn_scrub) * (right_ground - left_ground) / p_.track_m};
  const double turned = over_ground_.left_radps * kStep_s;
  direction_.turn(0.5 * turned);
  x_m_ += over_ground_.forward_mps * kStep_s * direction_.x;
  y_m_ += over_ground_.forward_mps * kStep_s * direction_.y;
  direction_.turn(0.5 * turned);
  heading_rad_ += turned;
}

}  // namespace cgsr::sim
