#pragma once

#include <cstdint>
#include <optional>

#include "hal/can_bus.h"

namespace cgsr::sim {

// The base's side of the Segway RMP protocol. It is written from the protocol's description alone and shares nothing
// with the driver's codec (hal/rmp): where one of them is wrong, the two do not understand each other.

/// What the simulated base believes about its counts; an RMP 200.
struct WireScales {
  double command_counts_per_mps = 332.0;  // D1
  double command_counts_per_degps = 7.8;  // D2
  double velocity_counts_per_mps = 332.0;
  double counts_per_m = 33215.0;
  double counts_per_turn = 112644.0;
  double counts_per_nm = 1094.0;
  double counts_per_deg = 7.8;              // angles, and angles per second
  bool yaw_rate_positive_clockwise = true;  // D4
};

/// 0x0413: how fast to go, and perhaps an item to configure (0: none).
struct Order {
  int velocity_counts = 0;
  int turn_counts = 0;
  int item = 0;
  int value = 0;

  [[nodiscard]] double forward_mps(const WireScales& scales) const {
    return velocity_counts / scales.command_counts_per_mps;
  }
  [[nodiscard]] double left_radps(const WireScales& scales) const;
};
std::optional<Order> read_order(const hal::CanFrame& frame);

/// 0x0412.
bool is_shutdown(const hal::CanFrame& frame);

// Frames of the base; their stamps are for the sender to set. Angles in rad, positive: leaning forward, to the right,
// turning left. Arguments without a unit are counts or bits as they go onto the wire.
hal::CanFrame build_frame(std::uint16_t build, std::uint16_t ticker);  // 0x0400
hal::CanFrame attitude_frame(const WireScales& scales, double pitch_rad, double pitch_rate_radps, double roll_rad,
                             double roll_rate_radps);  // 0x0401
hal::CanFrame motion_frame(const WireScales& scales, double left_wheel_mps, double right_wheel_mps,
                           double turning_left_radps,
                           std::uint16_t servo_count);                                               // 0x0402
hal::CanFrame wheels_frame(std::uint32_t left_counts, std::uint32_t right_counts);                   // 0x0403
hal::CanFrame integrated_frame(std::uint32_t fore_aft_counts, std::uint32_t yaw_counts);             // 0x0404
hal::CanFrame torque_frame(const WireScales& scales, double left_nm, double right_nm);               // 0x0405
hal::CanFrame power_frame(int mode, int gain_schedule, double ui_battery_v, double base_battery_v);  // 0x0406
hal::CanFrame echo_frame(const Order& order);                                                        // 0x0407
hal::CanFrame off_frame(double ui_battery_v);                                                        // 0x0412
hal::CanFrame unexplained_frame();                                                                   // 0x0414
hal::CanFrame status_frame(std::uint16_t controller, std::uint16_t word1, std::uint16_t word2);      // 0x0680
hal::CanFrame interface_frame(double ui_battery_v);                                                  // 0x0688

/// Whole counts for a way or an angle, rounded down, as an encoder counts. Beyond 2^32 they wrap.
std::uint32_t encoder_counts(double amount, double counts_per_unit);

}  // namespace cgsr::sim
