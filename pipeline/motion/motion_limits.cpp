#include "pipeline/motion/motion_limits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace cgsr {

namespace {

constexpr double kPi = std::numbers::pi;

/// The largest cosine over the angles within `spread` of `angle`.
double max_cosine(double angle, double spread) {
  const double offset = std::abs(std::remainder(angle, 2.0 * kPi));  // from the direction whose cosine is 1
  return offset <= spread ? 1.0 : std::cos(offset - spread);
}

/// How far the robot may still go before it crosses one edge, `gap` ahead in the direction `edge_rad`.
double way_to_edge(double gap, double edge_rad, double travel_rad, double spread) {
  const double approach = max_cosine(travel_rad - edge_rad, spread);
  if (approach <= 0.0) return std::numeric_limits<double>::infinity();
  return std::max(0.0, gap) / approach;
}

}  // namespace

hal::Twist clamp(const hal::Twist& goal, const MotionParameters& limits) {
  return {std::clamp(goal.forward_mps, -limits.max_backward_mps, limits.max_forward_mps),
          std::clamp(goal.left_radps, -limits.max_turn_radps, limits.max_turn_radps)};
}

double speed_within_area(double forward_mps, const hal::Odometry& odometry, double age_s,
                         const MotionParameters& limits) {
  const KeepInParameters& area = limits.keep_in;
  if (!area.enabled || forward_mps == 0.0) return forward_mps;

  const double wanted = std::abs(forward_mps);
  const double present = std::copysign(1.0, forward_mps) * odometry.velocity.forward_mps;
  const double deceleration = limits.max_deceleration_mps2;
  const double unbraked_s = age_s + limits.reaction_s;
  const double until_standing_s = unbraked_s + std::max(wanted, present) / deceleration;
  const double spread = std::min(kPi, limits.max_turn_radps * until_standing_s);
  const double travel_rad = odometry.heading_rad + (forward_mps < 0.0 ? kPi : 0.0);
  const double way = std::min({way_to_edge(area.max_x_m - odometry.x_m, 0.0, travel_rad, spread),
                               way_to_edge(area.max_y_m - odometry.y_m, kPi / 2.0, travel_rad, spread),
                               way_to_edge(odometry.x_m - area.min_x_m, kPi, travel_rad, spread),
                               way_to_edge(odometry.y_m - area.min_y_m, -kPi / 2.0, travel_rad, spread)});

  // Both inequalities, solved for v.
  const double at = deceleration * unbraked_s;
  const double steady = std::sqrt(at * at + 2.0 * deceleration * way) - at;
  const double braking = std::sqrt(2.0 * deceleration * std::max(0.0, way - present * unbraked_s));
  return std::copysign(std::min({wanted, steady, braking}), forward_mps);
}

}  // namespace cgsr
