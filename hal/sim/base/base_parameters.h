#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hal/sim/base/wire.h"
#include "platform/parameters.h"

namespace cgsr::sim {

enum class BaseMode : std::uint8_t { kDisabled = 0, kTractor = 1, kBalance = 2, kPowerDown = 3 };

inline constexpr std::array kBaseModeNames = {Named<BaseMode>{"disabled", BaseMode::kDisabled},
                                              Named<BaseMode>{"tractor", BaseMode::kTractor},
                                              Named<BaseMode>{"balance", BaseMode::kBalance}};
constexpr std::string_view to_string(BaseMode mode) {
  return mode == BaseMode::kPowerDown ? "power_down" : word_in(kBaseModeNames, mode);  // no start is in that mode
}

/// How the simulated Segway moves. Invented where no figure is known: the bus protocol fixes what it says, not how it
/// drives.
struct BaseParameters {
  BaseMode mode = BaseMode::kBalance;
  double max_acceleration_mps2 = 3.5;
  double velocity_lag_s = 0.03;
  double max_turn_acceleration_radps2 = 6.0;
  double turn_lag_s = 0.08;
  double turn_knee_mps = 1.57;
  double balance_rate_radps = 14.0;
  double balance_damping = 0.8;
  double pendulum_length_m = 0.12;
  double axle_height_m = 0.24;
  double track_m = 0.5398;
  double brake_mps2 = 2.5;
  double slip = 0.005;
  double slip_time_s = 1.0;
  double turn_scrub = 0.01;
  double pitch_noise_rad = 0.001;
  double wire_turn_counts_per_degps = 7.8;
  bool wire_yaw_rate_clockwise = true;
  int first_counts = 123456;
  int first_servo_count = 4711;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("mode", self.mode, kBaseModeNames, "operational mode when it is switched on");
    visit.number("max_acceleration_mps2", self.max_acceleration_mps2, {0.1, 5.0}, "m/s²", "steepest change of speed");
    visit.number("velocity_lag_s", self.velocity_lag_s, {0.005, 1.0}, "s", "time constant of the speed");
    visit.number("max_turn_acceleration_radps2", self.max_turn_acceleration_radps2, {0.1, 50.0}, "rad/s²",
                 "steepest change of the turn rate");
    visit.number("turn_lag_s", self.turn_lag_s, {0.005, 1.0}, "s", "time constant of the turn rate");
    visit.number(
        "turn_knee_mps", self.turn_knee_mps, {0.1, 10.0}, "m/s",
        "above this speed a turn command is taken for a lateral acceleration: the turn shrinks with the speed");
    visit.number("balance_rate_radps", self.balance_rate_radps, {1.0, 20.0}, "rad/s",
                 "natural frequency of the balancing");
    visit.number("balance_damping", self.balance_damping, {0.3, 2.0}, "1", "its damping ratio");
    visit.number("pendulum_length_m", self.pendulum_length_m, {0.01, 2.0}, "m",
                 "length of the pendulum that the body is: how far the wheels go back before it leans forward");
    visit.number("axle_height_m", self.axle_height_m, {0.05, 1.0}, "m",
                 "height of the axle, about which the body pitches");
    visit.number("track_m", self.track_m, {0.1, 2.0}, "m", "distance of the wheels");
    visit.number("brake_mps2", self.brake_mps2, {0.1, 10.0}, "m/s²", "deceleration without motors");
    visit.number("slip", self.slip, {0.0, 0.2}, "1", "standard deviation of a wheel's slip");
    visit.number("slip_time_s", self.slip_time_s, {0.01, 100.0}, "s", "time in which the slip changes");
    visit.number("turn_scrub", self.turn_scrub, {0.0, 0.3}, "1", "part of every turn that the tyres lose");
    visit.number("pitch_noise_rad", self.pitch_noise_rad, {0.0, 0.1}, "rad",
                 "standard deviation of the reported pitch");
    visit.number("wire_turn_counts_per_degps", self.wire_turn_counts_per_degps, {1.0, 50.0}, "1/(deg/s)",
                 "how this base's firmware takes turn commands");
    visit.flag("wire_yaw_rate_clockwise", self.wire_yaw_rate_clockwise,
               "whether it reports clockwise yaw rates as positive");
    visit.number("first_counts", self.first_counts, {-2000000000, 2000000000}, "counts",
                 "where the integrated displacements start: real ones start anywhere");
    visit.number("first_servo_count", self.first_servo_count, {0, 65535}, "counts",
                 "where the servo frame counter starts");
  }
};

}  // namespace cgsr::sim
