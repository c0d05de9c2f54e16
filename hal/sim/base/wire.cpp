#include "hal/sim/base/wire.h"

#include <algorithm>
#include <cmath>

namespace cgsr::sim {
namespace {

using hal::CanFrame;

constexpr double kDegrees = 57.295779513082321;  // in a radian

/// Fills a payload from its first byte on.
class Writer {
 public:
  explicit Writer(std::uint16_t id) { frame_.id = id; }

  Writer& word(std::uint32_t value) {  // the low 16 bits, most significant byte first
    frame_.data[frame_.size++] = static_cast<std::uint8_t>(value / 256);
    frame_.data[frame_.size++] = static_cast<std::uint8_t>(value);
    return *this;
  }
  Writer& quantity(double value, double counts_per_unit) {
    const double counts = std::clamp(std::nearbyint(value * counts_per_unit), -32768.0, 32767.0);
    return word(static_cast<std::uint32_t>(static_cast<std::int32_t>(counts)));
  }
  Writer& low_then_high(std::uint32_t value) { return word(value).word(value / 65536); }

  [[nodiscard]] CanFrame done() {
    frame_.size = 8;
    return frame_;
  }

 private:
  CanFrame frame_;
};

int whole_word(const CanFrame& frame, std::size_t byte) {
  return frame.data[byte] * 256 + frame.data[byte + 1];
}

int twos_complement(int word) {
  return word >= 32768 ? word - 65536 : word;
}

std::uint32_t ui_counts(double volts) {
  return static_cast<std::uint32_t>(std::nearbyint((volts - 1.4) / 0.0125));
}

}  // namespace

double Order::left_radps(const WireScales& scales) const {
  return turn_counts / scales.command_counts_per_degps / kDegrees;
}

std::optional<Order> read_order(const CanFrame& frame) {
  if (frame.id != 0x413 || frame.size != 8) return std::nullopt;
  return Order{.velocity_counts = std::clamp(twos_complement(whole_word(frame, 0)), -1176, 1176),
               .turn_counts = std::clamp(twos_complement(whole_word(frame, 2)), -1024, 1024),
               .item = whole_word(frame, 4),
               .value = whole_word(frame, 6)};
}

bool is_shutdown(const CanFrame& frame) {
  return frame.id == 0x412;
}

CanFrame build_frame(std::uint16_t build, std::uint16_t ticker) {
  return Writer(0x400).word(build).word(0).word(0).word(ticker).done();
}

CanFrame attitude_frame(const WireScales& scales, double pitch_rad, double pitch_rate_radps, double roll_rad,
                        double roll_rate_radps) {
  const double per_rad = scales.counts_per_deg * kDegrees;
  return Writer(0x401)
      .quantity(pitch_rad, per_rad)
      .quantity(pitch_rate_radps, per_rad)
      .quantity(roll_rad, per_rad)
      .quantity(roll_rate_radps, per_rad)
      .done();
}

CanFrame motion_frame(const WireScales& scales, double left_wheel_mps, double right_wheel_mps,
                      double turning_left_radps, std::uint16_t servo_count) {
  const double on_the_wire = scales.yaw_rate_positive_clockwise ? -turning_left_radps : turning_left_radps;
  return Writer(0x402)
      .quantity(left_wheel_mps, scales.velocity_counts_per_mps)
      .quantity(right_wheel_mps, scales.velocity_counts_per_mps)
      .quantity(on_the_wire, scales.counts_per_deg * kDegrees)
      .word(servo_count)
      .done();
}

CanFrame wheels_frame(std::uint32_t left_counts, std::uint32_t right_counts) {
  return Writer(0x403).low_then_high(left_counts).low_then_high(right_counts).done();
}

CanFrame integrated_frame(std::uint32_t fore_aft_counts, std::uint32_t yaw_counts) {
  return Writer(0x404).low_then_high(fore_aft_counts).low_then_high(yaw_counts).done();
}

CanFrame torque_frame(const WireScales& scales, double left_nm, double right_nm) {
  return Writer(0x405)
      .quantity(left_nm, scales.counts_per_nm)
      .quantity(right_nm, scales.counts_per_nm)
      .word(0x80)
      .done();
}

CanFrame power_frame(int mode, int gain_schedule, double ui_battery_v, double base_battery_v) {
  return Writer(0x406)
      .word(static_cast<std::uint32_t>(mode))
      .word(static_cast<std::uint32_t>(gain_schedule))
      .word(ui_counts(ui_battery_v))
      .quantity(base_battery_v, 4.0)
      .done();
}

CanFrame echo_frame(const Order& order) {
  return Writer(0x407).quantity(order.velocity_counts, 1.0).quantity(order.turn_counts, 1.0).done();
}

CanFrame off_frame(double ui_battery_v) {
  return Writer(0x412).word(0).word(0).word(ui_counts(ui_battery_v)).done();
}

CanFrame unexplained_frame() {
  return Writer(0x414).word(0xAA40).done();
}

CanFrame status_frame(std::uint16_t controller, std::uint16_t word1, std::uint16_t word2) {
  return Writer(0x680).word(controller).word(word1).word(word2).done();
}

CanFrame interface_frame(double ui_battery_v) {
  return Writer(0x688).word(0).word(ui_counts(ui_battery_v)).done();
}

std::uint32_t encoder_counts(double amount, double counts_per_unit) {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(amount * counts_per_unit)));
}

}  // namespace cgsr::sim
