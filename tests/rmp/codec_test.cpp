// The two codecs, each by itself against frames worked out by hand from the protocol, and both against each other.

#include <cmath>
#include <cstdint>
#include <numbers>
#include <variant>

#include <gtest/gtest.h>

#include "hal/rmp/codec.h"
#include "hal/rmp/listener.h"
#include "hal/rmp/scales.h"
#include "hal/sim/base/wire.h"
#include "tests/rmp/frames.h"

namespace cgsr {
namespace {

using namespace hal::rmp;
using test::candump;
using test::frame;
using test::Random;

constexpr double kDegree = std::numbers::pi / 180.0;
const RmpScales kScales;
const sim::WireScales kWire;

template <class T>
T decoded(const hal::CanFrame& f) {
  const auto message = decode(f);
  EXPECT_TRUE(message) << candump(f);
  if (!message || !std::holds_alternative<T>(*message)) {
    ADD_FAILURE() << candump(f) << " is not what it should be";
    return {};
  }
  return std::get<T>(*message);
}

// --- the driver's codec

TEST(RmpCodecGolden, CommandForwardAndLeft) {
  const Command command = to_command({.forward_mps = 0.5, .left_radps = 30.0 * kDegree}, kScales);
  EXPECT_EQ(candump(encode(command)), "413#00A600EA00000000");
}

TEST(RmpCodecGolden, CommandBackward) {
  EXPECT_EQ(candump(encode(to_command({.forward_mps = -0.5}, kScales))), "413#FF5A000000000000");
}

TEST(RmpCodecGolden, BalanceMode) {
  const Command command{.configuration = static_cast<std::uint16_t>(Configuration::kOperationalMode),
                        .parameter = static_cast<std::uint16_t>(OperationalMode::kBalance)};
  EXPECT_EQ(candump(encode(command)), "413#0000000000100002");
}

TEST(RmpCodecGolden, ResetOfAllIntegrators) {
  const Command command{.configuration = static_cast<std::uint16_t>(Configuration::kResetIntegrators),
                        .parameter = 0x0F};
  EXPECT_EQ(candump(encode(command)), "413#000000000032000F");
}

TEST(RmpCodecGolden, Attitude) {
  const auto attitude = decoded<Attitude>(frame("401#000F0000FFF10000"));
  EXPECT_EQ(attitude, (Attitude{.pitch = 15, .pitch_rate = 0, .roll = -15, .roll_rate = 0}));
  EXPECT_NEAR(pitch_rad(attitude, kScales), 1.923 * kDegree, 0.0005 * kDegree);
}

TEST(RmpCodecGolden, Motion) {
  const auto motion = decoded<Motion>(frame("402#00A600A6FFEC0064"));
  EXPECT_EQ(motion, (Motion{.left = 166, .right = 166, .yaw_rate = -20, .servo_frame = 100}));
  EXPECT_DOUBLE_EQ(to_twist(motion, kScales).forward_mps, 0.5);
  EXPECT_NEAR(to_twist(motion, kScales).left_radps, 2.564 * kDegree,
              0.0005 * kDegree);  // clockwise is positive on the wire
}

TEST(RmpCodecGolden, WheelDistances) {
  const auto wheels = decoded<WheelDistances>(frame("403#81BF000081BF0000"));
  EXPECT_EQ(wheels, (WheelDistances{.left = 33215, .right = 33215}));
}

TEST(RmpCodecGolden, Integrated) {
  const auto integrated = decoded<Integrated>(frame("404#81BF0000B8040001"));
  EXPECT_EQ(integrated, (Integrated{.fore_aft = 33215, .yaw = 112644}));
}

TEST(RmpCodecGolden, ModeAndPower) {
  const auto power = decoded<ModeAndPower>(frame("406#00020000018A0130"));
  EXPECT_EQ(power.mode, OperationalMode::kBalance);
  EXPECT_EQ(power.gain_schedule, 0);
  EXPECT_DOUBLE_EQ(ui_battery_v(power, kScales), 6.325);
  EXPECT_DOUBLE_EQ(base_battery_v(power, kScales), 76.0);
}

TEST(RmpCodecGolden, StatusOfARunningBase) {
  const auto status = decoded<Status>(frame("680#0005008000000000"));
  EXPECT_EQ(status, (Status{.controller_mode = 5, .word1 = word1::kMotorsEnabled, .word2 = 0}));
}

TEST(RmpCodecGolden, StatusOfAnEmergencyStop) {
  const auto status = decoded<Status>(frame("680#0005000000020000"));
  EXPECT_EQ(status.word1 & word1::kMotorsEnabled, 0);
  EXPECT_NE(status.word2 & word2::kEmergencyStop, 0);
}

TEST(RmpCodec, WhatIsNotOfTheFamilyIsRefused) {
  EXPECT_EQ(decode(frame("500#0000000000000000")).error(), DecodeFailure::kUnknownId);
  EXPECT_EQ(decode(frame("402#00A600A6FFEC00")).error(), DecodeFailure::kWrongSize);
  EXPECT_TRUE(std::holds_alternative<Shutdown>(*decode(frame("412#"))));
  EXPECT_TRUE(std::holds_alternative<Ignored>(*decode(frame("414#AA40000000000000"))));
}

// The neighbours of each bit group in the status words, one bit at a time, against the table of the protocol.
TEST(RmpCodec, EveryStatusBitHasItsFault) {
  using hal::DriveFault;
  const auto fault = [](unsigned w1, unsigned w2) {
    RmpReport report;
    report.power.mode = OperationalMode::kBalance;
    report.status = {
        .controller_mode = 5, .word1 = static_cast<std::uint16_t>(w1), .word2 = static_cast<std::uint16_t>(w2)};
    return reported_fault(report);
  };
  const unsigned on = word1::kMotorsEnabled;
  EXPECT_EQ(fault(on, 0), DriveFault::kNone);
  EXPECT_EQ(fault(0, 0), DriveFault::kMotorsOff);
  for (const unsigned warning : {0x0002U, 0x0008U, 0x0010U, 0x0100U, 0x0200U, 0x0800U, 0x1000U, 0x2000U, 0x8000U}) {
    EXPECT_EQ(fault(on | warning, 0), DriveFault::kNone) << warning;  // 0x10 beside 0x80 is no emergency stop
  }
  EXPECT_EQ(fault(on | 0x0001, 0), DriveFault::kSafetyShutdown);
  EXPECT_EQ(fault(on | 0x0004, 0), DriveFault::kSafetyShutdown);
  EXPECT_EQ(fault(on | 0x0020, 0), DriveFault::kBaseFault);
  EXPECT_EQ(fault(on | 0x0040, 0), DriveFault::kBaseFault);
  EXPECT_EQ(fault(on | 0x0400, 0), DriveFault::kLowBattery);
  EXPECT_EQ(fault(on | 0x4000, 0), DriveFault::kLowBattery);
  for (const int side : {0, 8}) {
    for (const unsigned bit : {0x01U, 0x04U, 0x20U, 0x40U})
      EXPECT_EQ(fault(on, bit << side), DriveFault::kBaseFault) << bit;
    EXPECT_EQ(fault(on, 0x02U << side), DriveFault::kEmergencyStop);
    EXPECT_EQ(fault(on, 0x10U << side), DriveFault::kLowBattery);
    for (const unsigned warning : {0x08U, 0x80U}) EXPECT_EQ(fault(on, warning << side), DriveFault::kNone) << warning;
  }
}

TEST(RmpCodec, CommandsAreBoundedToWhatTheBaseTakes) {
  EXPECT_EQ(to_command({.forward_mps = 1e300, .left_radps = -1e300}, kScales),
            (Command{.velocity = 1176, .turn = -1024}));
  EXPECT_EQ(to_command({.forward_mps = -3.6, .left_radps = 2.4}, kScales), (Command{.velocity = -1176, .turn = 1024}));
}

TEST(RmpCodecProperty, CommandsComeBack) {
  Random random(20261121);
  for (int trial = 0; trial < 20000; ++trial) {
    const Command command{.velocity = static_cast<std::int16_t>(random.whole(-32768, 32767)),
                          .turn = static_cast<std::int16_t>(random.whole(-32768, 32767)),
                          .configuration = static_cast<std::uint16_t>(random.whole(0, 65535)),
                          .parameter = static_cast<std::uint16_t>(random.whole(0, 65535))};
    ASSERT_EQ(decoded<Command>(encode(command)), command) << trial;
  }
}

// --- the simulated base's codec

TEST(SimWireGolden, Orders) {
  const auto order = sim::read_order(frame("413#00A600EA00000000"));
  ASSERT_TRUE(order);
  EXPECT_DOUBLE_EQ(order->forward_mps(kWire), 0.5);
  EXPECT_NEAR(order->left_radps(kWire), 30.0 * kDegree, 1e-12);
  EXPECT_EQ(order->item, 0);

  EXPECT_DOUBLE_EQ(sim::read_order(frame("413#FF5A000000000000"))->forward_mps(kWire), -0.5);

  const auto balance = sim::read_order(frame("413#0000000000100002"));
  EXPECT_EQ(balance->item, 16);
  EXPECT_EQ(balance->value, 2);

  const auto reset = sim::read_order(frame("413#000000000032000F"));
  EXPECT_EQ(reset->item, 50);
  EXPECT_EQ(reset->value, 15);

  EXPECT_FALSE(sim::read_order(frame("413#00A600EA000000")));
  EXPECT_FALSE(sim::read_order(frame("402#00A600EA00000000")));
  EXPECT_EQ(sim::read_order(frame("413#7FFF800000000000"))->velocity_counts, 1176);
  EXPECT_EQ(sim::read_order(frame("413#7FFF800000000000"))->turn_counts, -1024);
}

TEST(SimWireGolden, Frames) {
  const double tilt = 15.0 / 7.8 * kDegree;
  EXPECT_EQ(candump(sim::attitude_frame(kWire, tilt, 0.0, -tilt, 0.0)), "401#000F0000FFF10000");
  EXPECT_EQ(candump(sim::motion_frame(kWire, 0.5, 0.5, 20.0 / 7.8 * kDegree, 100)), "402#00A600A6FFEC0064");
  EXPECT_EQ(candump(sim::wheels_frame(sim::encoder_counts(1.0, kWire.counts_per_m),
                                      sim::encoder_counts(1.0, kWire.counts_per_m))),
            "403#81BF000081BF0000");
  EXPECT_EQ(candump(sim::integrated_frame(sim::encoder_counts(1.0, kWire.counts_per_m),
                                          sim::encoder_counts(1.0, kWire.counts_per_turn))),
            "404#81BF0000B8040001");
  EXPECT_EQ(candump(sim::power_frame(2, 0, 6.325, 76.0)), "406#00020000018A0130");
  EXPECT_EQ(candump(sim::status_frame(5, 0x0080, 0)), "680#0005008000000000");
  EXPECT_EQ(candump(sim::status_frame(5, 0, 0x0002)), "680#0005000000020000");
}

// --- both against each other

// Half a count is what rounding may cost; a sign, a byte order or a scale that differs costs more.
TEST(RmpCodecProperty, TheBaseUnderstandsTheDriver) {
  Random random(1);
  for (int trial = 0; trial < 20000; ++trial) {
    const hal::Twist twist{.forward_mps = random.real(-3.5, 3.5), .left_radps = random.real(-2.2, 2.2)};
    const auto order = sim::read_order(encode(to_command(twist, kScales)));
    ASSERT_TRUE(order);
    ASSERT_NEAR(order->forward_mps(kWire), twist.forward_mps, 0.5001 / 332.0) << trial;
    ASSERT_NEAR(order->left_radps(kWire), twist.left_radps, 0.5001 / 7.8 * kDegree) << trial;
  }
}

TEST(RmpCodecProperty, TheDriverUnderstandsTheBase) {
  Random random(2);
  for (int trial = 0; trial < 20000; ++trial) {
    const double left = random.real(-3.5, 3.5), right = random.real(-3.5, 3.5), turn = random.real(-4.0, 4.0);
    const auto servo = static_cast<std::uint16_t>(random.whole(0, 65535));
    const auto motion = decoded<Motion>(sim::motion_frame(kWire, left, right, turn, servo));
    ASSERT_NEAR(to_twist(motion, kScales).forward_mps, 0.5 * (left + right), 0.5001 / 332.0) << trial;
    ASSERT_NEAR(to_twist(motion, kScales).left_radps, turn, 0.5001 / 7.8 * kDegree) << trial;
    ASSERT_EQ(motion.servo_frame, servo);

    const double pitch = random.real(-1.0, 1.0);
    const auto attitude = decoded<Attitude>(sim::attitude_frame(kWire, pitch, 0.3, -0.2, 0.1));
    ASSERT_NEAR(pitch_rad(attitude, kScales), pitch, 0.5001 / 7.8 * kDegree) << trial;

    const auto a = static_cast<std::uint32_t>(random.whole(0, 0xFFFFFFFF));
    const auto b = static_cast<std::uint32_t>(random.whole(0, 0xFFFFFFFF));
    ASSERT_EQ(decoded<WheelDistances>(sim::wheels_frame(a, b)), (WheelDistances{a, b})) << trial;
    ASSERT_EQ(decoded<Integrated>(sim::integrated_frame(a, b)), (Integrated{a, b})) << trial;

    const auto w1 = static_cast<std::uint16_t>(a), w2 = static_cast<std::uint16_t>(b);
    ASSERT_EQ(decoded<Status>(sim::status_frame(5, w1, w2)), (Status{5, w1, w2})) << trial;
    ASSERT_EQ(decoded<Build>(sim::build_frame(w1, w2)), (Build{w1})) << trial;

    const sim::Order order{.velocity_counts = static_cast<int>(random.whole(-1176, 1176)),
                           .turn_counts = static_cast<int>(random.whole(-1024, 1024))};
    const auto echo = decoded<Echo>(sim::echo_frame(order));
    ASSERT_EQ(echo.velocity, order.velocity_counts) << trial;
    ASSERT_EQ(echo.turn, order.turn_counts) << trial;

    const double volts = 0.25 * static_cast<double>(random.whole(200, 340));
    const auto power = decoded<ModeAndPower>(sim::power_frame(static_cast<int>(random.whole(0, 3)), 1, 6.325, volts));
    ASSERT_DOUBLE_EQ(base_battery_v(power, kScales), volts) << trial;
  }
}

TEST(RmpCodec, OddScalesAreSeenByBothSides) {
  RmpScales scales;
  scales.yaw_rate_sign = Sign::kAsReported;
  scales.turn_command_per_degps = 333.3 * kDegree;
  sim::WireScales wire;
  wire.yaw_rate_positive_clockwise = false;
  wire.command_counts_per_degps = 333.3 * kDegree;
  const auto motion = decoded<Motion>(sim::motion_frame(wire, 0.0, 0.0, 1.0, 0));
  EXPECT_NEAR(to_twist(motion, scales).left_radps, 1.0, 0.01);
  EXPECT_NEAR(to_twist(motion, kScales).left_radps, -1.0, 0.01);
  EXPECT_NEAR(sim::read_order(encode(to_command({.left_radps = 1.0}, scales)))->left_radps(wire), 1.0, 0.01);
}

}  // namespace
}  // namespace cgsr
