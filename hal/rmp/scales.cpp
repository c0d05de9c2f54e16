#include "hal/rmp/scales.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::hal::rmp {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

std::int16_t to_counts(double value, std::int16_t most) {
  // Bounded before it is rounded: lround of a large value is undefined.
  return static_cast<std::int16_t>(std::lround(std::clamp<double>(value, -most, most)));
}

double factor(Sign sign) {
  return sign == Sign::kNegated ? -1.0 : 1.0;
}

}  // namespace

Command to_command(const Twist& twist, const RmpScales& scales) {
  return {.velocity = to_counts(twist.forward_mps * scales.velocity_command_per_mps, kMostVelocityCounts),
          .turn = to_counts(twist.left_radps * kDegreesPerRadian * scales.turn_command_per_degps, kMostTurnCounts)};
}

Twist to_twist(const Motion& motion, const RmpScales& scales) {
  return {.forward_mps = (motion.left + motion.right) / (2.0 * scales.velocity_per_mps),
          .left_radps = factor(scales.yaw_rate_sign) * motion.yaw_rate / (scales.rate_per_degps * kDegreesPerRadian)};
}

double pitch_rad(const Attitude& attitude, const RmpScales& scales) {
  return factor(scales.pitch_sign) * attitude.pitch / (scales.angle_per_deg * kDegreesPerRadian);
}

double base_battery_v(const ModeAndPower& power, const RmpScales& scales) {
  return power.base_battery / scales.base_battery_per_v;
}

double ui_battery_v(const ModeAndPower& power, const RmpScales& scales) {
  return scales.ui_battery_offset_v + scales.ui_battery_v_per_count * power.ui_battery;
}

}  // namespace cgsr::hal::rmp
