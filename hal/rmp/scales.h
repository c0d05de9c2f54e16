#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hal/drive.h"
#include "hal/rmp/messages.h"
#include "platform/parameters.h"

namespace cgsr::hal::rmp {

enum class Sign : std::uint8_t { kAsReported, kNegated };

inline constexpr std::array kSignNames = {Named<Sign>{"as_reported", Sign::kAsReported},
                                          Named<Sign>{"negated", Sign::kNegated}};
constexpr std::string_view to_string(Sign sign) {
  return word_in(kSignNames, sign);
}

/// Counts per unit. The defaults are the RMP 200's and 400's; README.md has the RMP 50's and what is disputed about
/// which (D1, D2, D4).
struct RmpScales {
  double velocity_command_per_mps = 332.0;  // D1
  double turn_command_per_degps = 7.8;      // D2
  double velocity_per_mps = 332.0;
  double displacement_per_m = 33215.0;
  double yaw_per_rev = 112644.0;
  double angle_per_deg = 7.8;
  double rate_per_degps = 7.8;
  Sign yaw_rate_sign = Sign::kNegated;  // D4: clockwise is positive on the wire
  Sign pitch_sign = Sign::kAsReported;
  double base_battery_per_v = 4.0;
  double ui_battery_offset_v = 1.4;
  double ui_battery_v_per_count = 0.0125;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("velocity_command_per_mps", self.velocity_command_per_mps, {100.0, 1000.0}, "1/(m/s)",
                 "The counts of a velocity command per m/s; some drivers use 328.85.");
    visit.number(
        "turn_command_per_degps", self.turn_command_per_degps, {1.0, 50.0}, "1/(deg/s)",
        "The counts of a turn command per degree per second; this depends on the firmware and has to be calibrated.");
    visit.number("velocity_per_mps", self.velocity_per_mps, {100.0, 1000.0}, "1/(m/s)",
                 "The counts of a reported wheel velocity per m/s.");
    visit.number("displacement_per_m", self.displacement_per_m, {1000.0, 100000.0}, "1/m",
                 "The counts of the reported displacement per metre.");
    visit.number("yaw_per_rev", self.yaw_per_rev, {10000.0, 1000000.0}, "1/rev",
                 "The counts of the integrated yaw per full revolution.");
    visit.number("angle_per_deg", self.angle_per_deg, {1.0, 100.0}, "1/deg",
                 "The counts of the pitch angle per degree.");
    visit.number("rate_per_degps", self.rate_per_degps, {1.0, 100.0}, "1/(deg/s)",
                 "The counts of the yaw rate per degree per second.");
    visit.choice("yaw_rate_sign", self.yaw_rate_sign, kSignNames,
                 "Choose negated when the base reports a clockwise yaw rate as positive; observe it on the robot.");
    visit.choice("pitch_sign", self.pitch_sign, kSignNames,
                 "Choose as_reported when the base reports leaning forward as positive.");
    visit.number("base_battery_per_v", self.base_battery_per_v, {0.1, 100.0}, "1/V",
                 "The counts of the power base's battery per volt.");
    visit.number("ui_battery_offset_v", self.ui_battery_offset_v, {0.0, 10.0}, "V",
                 "The voltage of the user interface's battery at count zero.");
    visit.number("ui_battery_v_per_count", self.ui_battery_v_per_count, {0.0001, 1.0}, "V/count",
                 "The voltage of the user interface's battery per count.");
  }
};

/// \return the pure motion command for a finite `twist`, rounded to the nearest count and bounded to what the base
/// takes. Not done: above about 1.57 m/s the base takes the turn for a lateral acceleration (D3) and turns less than it
/// was told.
Command to_command(const Twist& twist, const RmpScales& scales);

/// Forward is the mean of the wheels.
Twist to_twist(const Motion& motion, const RmpScales& scales);

/// Positive leans forward.
double pitch_rad(const Attitude& attitude, const RmpScales& scales);

double base_battery_v(const ModeAndPower& power, const RmpScales& scales);
double ui_battery_v(const ModeAndPower& power, const RmpScales& scales);

}  // namespace cgsr::hal::rmp
