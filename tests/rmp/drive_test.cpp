// The driver over the virtual bus, with a base that does as it is told.

#include "hal/rmp/rmp_drive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "hal/rmp/codec.h"
#include "tests/rmp/frames.h"
#include "tests/rmp/rig.h"

namespace cgsr {
namespace {

using hal::DriveFailure;
using hal::DriveFault;
using test::at;
using test::kBegin;
using test::kForward;
using test::kStand;
using test::Rig;

/// The commands on the wire, in their order.
class Commands {
 public:
  explicit Commands(Rig& rig) : bus_(rig.segway.bus()) {
    bus_.tap([this](const hal::CanFrame& frame) {
      if (frame.id == 0x413) frames_.push_back(frame);
    });
  }
  ~Commands() {
    bus_.tap([](const hal::CanFrame&) {});  // the rig says one more word when it ends
  }
  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;
  [[nodiscard]] const std::vector<hal::CanFrame>& frames() const { return frames_; }
  [[nodiscard]] Duration longest_gap() const {
    return gap([](auto a, auto b) { return std::max(a, b); }, Duration{});
  }
  [[nodiscard]] Duration shortest_gap() const {
    return gap([](auto a, auto b) { return std::min(a, b); }, Duration::max());
  }

 private:
  template <class Pick>
  [[nodiscard]] Duration gap(Pick pick, Duration picked) const {
    for (std::size_t i = 1; i < frames_.size(); ++i) picked = pick(picked, frames_[i].stamp - frames_[i - 1].stamp);
    return picked;
  }
  sim::VirtualCanBus& bus_;
  std::vector<hal::CanFrame> frames_;
};

hal::rmp::Command command_in(const hal::CanFrame& frame) {
  return std::get<hal::rmp::Command>(*hal::rmp::decode(frame));
}

TEST(RmpDrive, FollowsCommands) {
  Rig rig;
  ASSERT_TRUE(rig.run_until(0.5, kStand));
  ASSERT_TRUE(rig.run_until(3.5, {.forward_mps = 0.4, .left_radps = 0.3}));
  EXPECT_NEAR(rig.odometry.velocity.forward_mps, 0.4, 0.005);
  EXPECT_NEAR(rig.odometry.velocity.left_radps, 0.3, 0.005);
  EXPECT_NEAR(rig.true_speed_mps(), 0.4, 0.02);

  const auto truth = rig.segway.base().state_at(rig.odometry.stamp);
  EXPECT_NEAR(rig.odometry.x_m, truth.x_m, 0.02);
  EXPECT_NEAR(rig.odometry.y_m, truth.y_m, 0.02);
  EXPECT_NEAR(rig.odometry.heading_rad, truth.heading_rad, 0.03);
  EXPECT_GT(rig.odometry.y_m, 0.2) << "left is left";
}

TEST(RmpDrive, PitchIsThatOfTheBody) {
  Rig rig;
  (void)rig.run_until(0.5, kStand);
  double most = 0.0;
  for (int cycle = 0; cycle < 100; ++cycle) {
    (void)rig.cycle({.forward_mps = 0.004 * cycle});
    const double truth = rig.segway.base().state_at(rig.odometry.stamp).pitch_rad;
    EXPECT_NEAR(rig.odometry.pitch_rad, truth, 0.012);  // a set of 10 ms, noise, and a count is 0.13 degrees
    most = std::max(most, rig.odometry.pitch_rad);
  }
  EXPECT_GT(most, 0.03) << "it leans forward, not back";
}

TEST(RmpDrive, IsReadyAfterWholeSetsInARow) {
  Rig rig;
  EXPECT_EQ(rig.drive.fault(), DriveFault::kStarting);
  EXPECT_EQ(rig.drive.command(kForward, kBegin).error(), DriveFailure::kNoFeedback);
  EXPECT_EQ(rig.run_until(0.05, kForward).error(), DriveFailure::kNotReady);
  EXPECT_EQ(rig.drive.fault(), DriveFault::kStarting);
  EXPECT_TRUE(rig.run_until(0.12, kForward));
  EXPECT_EQ(rig.drive.fault(), DriveFault::kNone);
  EXPECT_EQ(rig.drive.counters().feedback.sets, 11U);
}

TEST(RmpDrive, OneCommandInTenMillisecondsHoweverOftenItIsAsked) {
  Rig rig;
  (void)rig.run_until(0.2, kStand);
  const Commands commands(rig);
  for (int i = 0; i < 1000; ++i) {
    rig.now += seconds(0.001);
    (void)rig.drive.command({.forward_mps = 0.1 + 0.0001 * i}, rig.now);
  }
  EXPECT_GE(commands.frames().size(), 99U);
  EXPECT_LE(commands.frames().size(), 101U);
  EXPECT_GE(commands.shortest_gap(), seconds(0.0095));  // on the wire, where one may wait for another
}

// A control cycle that begins some microseconds less than 10 ms after another has its turn all the same.
TEST(RmpDrive, EveryCycleThatJittersSendsItsCommand) {
  Rig rig;
  (void)rig.run_until(0.2, kStand);
  const Commands commands(rig);
  std::mt19937 random(20261125);
  std::uniform_int_distribution<int> jitter_us(0, 400);
  const MonoTime begin = rig.now;
  for (int i = 1; i <= 1000; ++i) {
    rig.now = begin + i * seconds(0.010) + std::chrono::microseconds(jitter_us(random));
    (void)rig.drive.odometry(rig.now);
    (void)rig.drive.command({.forward_mps = 0.1}, rig.now);
  }
  EXPECT_EQ(commands.frames().size(), 1000U);
  EXPECT_GE(commands.shortest_gap(), seconds(0.0095));
}

TEST(RmpDrive, ACommandThatHadToWaitGoesOutWithTheNextListening) {
  Rig rig;
  (void)rig.run_until(0.2, kStand);
  const Commands commands(rig);
  ASSERT_TRUE(rig.drive.command({.forward_mps = 0.1}, rig.now + seconds(0.010)));
  ASSERT_TRUE(rig.drive.command({.forward_mps = 0.2}, rig.now + seconds(0.011)));
  ASSERT_EQ(commands.frames().size(), 1U);
  ASSERT_TRUE(rig.drive.odometry(rig.now + seconds(0.020)));
  ASSERT_EQ(commands.frames().size(), 2U);
  EXPECT_EQ(command_in(commands.frames().back()).velocity, 66);
}

TEST(RmpDrive, HoldsACommandForAWhileAndThenCommandsZero) {
  Rig rig;
  (void)rig.run_until(2.0, kForward);
  const Commands commands(rig);
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(rig.drive.odometry(rig.now += seconds(0.010)));
  ASSERT_FALSE(commands.frames().empty());
  EXPECT_LE(commands.longest_gap(), seconds(0.3)) << "the base must hear something every 300 ms";
  for (const auto& frame : commands.frames()) {
    const bool holds = frame.stamp < at(2.0 + 0.151);
    EXPECT_EQ(command_in(frame).velocity, holds ? 133 : 0) << to_seconds(frame.stamp - kBegin);
  }
  EXPECT_LT(commands.frames()[1].stamp, at(2.0 + 0.17)) << "zero does not wait for the next repetition";
  EXPECT_NEAR(rig.true_speed_mps(), 0.0, 0.005);
}

TEST(RmpDrive, IsSilentUntilTheFirstCommand) {
  Rig::Setup setup;
  setup.drive.mode_at_start = hal::rmp::ModeAtStart::kTractor;  // asked for with the first command, not before
  Rig rig(setup);
  const Commands commands(rig);
  for (int i = 0; i < 100; ++i) (void)rig.drive.odometry(rig.now += seconds(0.010));
  rig.drive.stop();
  EXPECT_TRUE(commands.frames().empty());
}

TEST(RmpDrive, NonFiniteCommandsChangeNothing) {
  Rig rig;
  (void)rig.run_until(2.0, kForward);
  const auto refused =
      rig.drive.command({.forward_mps = std::numeric_limits<double>::quiet_NaN()}, rig.now += seconds(0.01));
  EXPECT_EQ(refused.error(), DriveFailure::kSendFailed);
  const Commands commands(rig);
  (void)rig.drive.odometry(rig.now += seconds(0.10));
  ASSERT_FALSE(commands.frames().empty());
  EXPECT_EQ(command_in(commands.frames().back()).velocity, 133);
}

TEST(RmpDrive, TheLastWordIsZero) {
  Rig rig;
  (void)rig.run_until(1.0, kForward);
  const Commands commands(rig);
  rig.drive.stop();
  ASSERT_EQ(commands.frames().size(), 1U);
  EXPECT_EQ(command_in(commands.frames().front()), hal::rmp::Command{});
  EXPECT_EQ(rig.drive.command(kForward, rig.now).error(), DriveFailure::kNotStarted);
}

TEST(RmpDrive, CountersThatWrapOnTheWayDoNotShow) {
  Rig::Setup setup;
  setup.base.first_counts = -5000;  // both ways wrap after 15 cm
  setup.base.first_servo_count = 65436;
  setup.base.slip = 0.0;
  setup.base.turn_scrub = 0.0;
  Rig rig(setup);
  (void)rig.run_until(0.5, kStand);
  ASSERT_TRUE(rig.run_until(3.0, {.forward_mps = 0.4, .left_radps = 0.4}));
  const auto truth = rig.segway.base().state_at(rig.odometry.stamp);
  EXPECT_NEAR(rig.odometry.x_m, truth.x_m, 0.003);
  EXPECT_NEAR(rig.odometry.y_m, truth.y_m, 0.003);
  EXPECT_NEAR(rig.odometry.heading_rad, truth.heading_rad, 0.003);
  EXPECT_EQ(rig.drive.counters().feedback.jumps, 0U);
  EXPECT_EQ(rig.drive.counters().feedback.lost_sets, 0U);
}

TEST(RmpDrive, NothingIsAmissInAQuietRun) {
  Rig rig;
  (void)rig.run_until(5.0, kForward);
  const auto counters = rig.drive.counters();
  EXPECT_EQ(counters.feedback.sets, 499U);  // the set of this very moment is still on the wire
  EXPECT_EQ(counters.feedback.late, 0U);
  EXPECT_EQ(counters.feedback.lost_sets, 0U);
  EXPECT_EQ(counters.feedback.implausible, 0U);
  EXPECT_EQ(counters.feedback.jumps, 0U);
  EXPECT_EQ(counters.feedback.undecodable, 0U);
  EXPECT_EQ(counters.feedback.echo_mismatches, 0U);
  EXPECT_EQ(counters.feedback.foreign_commands, 0U);
  EXPECT_EQ(counters.commands, 500U);
  EXPECT_EQ(counters.unsent, 0U);
  EXPECT_EQ(counters.bus.lost, 0U);
  EXPECT_EQ(rig.drive.report().firmware_build, 0x07F0);
}

TEST(RmpDrive, AsksForTheModeThatTheConfigurationWants) {
  Rig::Setup setup;
  setup.base.mode = sim::BaseMode::kDisabled;
  Rig left_alone(setup);
  EXPECT_EQ(left_alone.run_until(1.0, kForward).error(), DriveFailure::kNotReady);
  EXPECT_EQ(left_alone.drive.fault(), DriveFault::kMotorsOff);

  setup.drive.mode_at_start = hal::rmp::ModeAtStart::kBalance;
  Rig asked(setup);
  EXPECT_TRUE(asked.run_until(1.0, kForward));
  EXPECT_EQ(asked.drive.report().power.mode, hal::rmp::OperationalMode::kBalance);

  setup.base.mode = sim::BaseMode::kBalance;
  setup.drive.mode_at_start = hal::rmp::ModeAtStart::kTractor;
  Rig changed(setup);
  EXPECT_TRUE(changed.run_until(1.0, kForward));
  EXPECT_EQ(changed.drive.report().power.mode, hal::rmp::OperationalMode::kTractor);
}

// Whoever closes it again and arms has the base asked for its mode then, as one that woke up well is.
TEST(RmpDrive, AsksForTheModeOnceAnEmergencyStopThatWasOpenFromTheStartIsClosed) {
  Rig::Setup setup;
  setup.base.mode = sim::BaseMode::kDisabled;
  setup.base_script = {{.trouble = sim::BaseTrouble::kEmergencyStop, .to = at(1.0)}};
  setup.drive.mode_at_start = hal::rmp::ModeAtStart::kBalance;
  Rig rig(setup);
  (void)rig.run_until(0.5, kStand);
  EXPECT_EQ(rig.drive.fault(), DriveFault::kEmergencyStop);
  (void)rig.run_until(1.5, kStand);
  EXPECT_EQ(rig.drive.fault(), DriveFault::kMotorsOff);
  EXPECT_EQ(rig.drive.report().power.mode, hal::rmp::OperationalMode::kDisabled) << "until somebody arms";
  EXPECT_EQ(rig.drive.rearm(rig.now).error(), DriveFault::kMotorsOff);
  (void)rig.run_until(2.5, kStand);
  EXPECT_TRUE(rig.drive.rearm(rig.now));
  EXPECT_TRUE(rig.run_until(3.0, kForward));
  EXPECT_EQ(rig.drive.report().power.mode, hal::rmp::OperationalMode::kBalance);
}

// A wrong turn scale shows as a turn that is not what was commanded: that is how it is calibrated.
TEST(RmpDrive, AnotherFirmwareTurnsAtAnotherRate) {
  Rig::Setup setup;
  setup.base.wire_turn_counts_per_degps = 5.817;  // 333.3 counts per rad/s
  Rig rig(setup);
  (void)rig.run_until(3.0, {.left_radps = 0.4});
  EXPECT_NEAR(rig.odometry.velocity.left_radps, 0.4 * 7.8 / 5.817, 0.01);
}

// The first turn shows it: the robot stops, and stays stopped until somebody corrects the configuration.
TEST(RmpDrive, AWrongSignOfTheYawRateIsNoticedAgainstTheWheels) {
  Rig::Setup setup;
  setup.base.wire_yaw_rate_clockwise = false;
  Rig rig(setup);
  (void)rig.run_until(1.0, kStand);
  const auto noticed_s = rig.run_until_fault(hal::DriveFault::kYawContradiction, {.left_radps = 0.4});
  ASSERT_TRUE(noticed_s);
  EXPECT_LT(*noticed_s, 1.0);
  EXPECT_LT(rig.odometry.velocity.left_radps, -0.05);
  (void)rig.run_until(5.0, kStand);
  EXPECT_FALSE(rig.drive.rearm(rig.now));
  EXPECT_EQ(rig.drive.fault(), hal::DriveFault::kYawContradiction);
}

TEST(RmpDrive, TheRightSignOfTheYawRateIsNoFaultInAnyTurn) {
  Rig rig;
  for (int i = 0; i < 8; ++i) (void)rig.run_until(1.0 + i, {.forward_mps = 0.3, .left_radps = i % 2 == 0 ? 0.6 : -0.6});
  EXPECT_EQ(rig.drive.fault(), hal::DriveFault::kNone);
}

}  // namespace
}  // namespace cgsr
