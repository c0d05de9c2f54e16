#include "hal/dummy/kinematic_drive.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace cgsr::hal {
namespace {

MonoTime at(double s) {
  return MonoTime{seconds(s)};
}

// Commands `twist` every 10 ms from `from` until `to`.
void keep_commanding(KinematicDrive& drive, const Twist& twist, double from, double to) {
  for (int i = 0; from + 0.01 * i < to - 1e-6; ++i) ASSERT_TRUE(drive.command(twist, at(from + 0.01 * i)));
}

// Constant acceleration to v, then v: x = v t - v^2 / (2 a).
TEST(KinematicDrive, AcceleratesWithItsLimit) {
  KinematicDriveParameters parameters;
  parameters.forward_acceleration_mps2 = 0.5;
  KinematicDrive drive(parameters);
  ASSERT_TRUE(drive.start());
  keep_commanding(drive, {0.4, 0.0}, 0.0, 0.4);
  EXPECT_NEAR(drive.odometry(at(0.4))->velocity.forward_mps, 0.2, 1e-9);
  EXPECT_NEAR(drive.odometry(at(0.4))->x_m, 0.04, 1e-9);
  keep_commanding(drive, {0.4, 0.0}, 0.4, 2.0);
  EXPECT_NEAR(drive.odometry(at(2.0))->velocity.forward_mps, 0.4, 1e-9);
  EXPECT_NEAR(drive.odometry(at(2.0))->x_m, 0.4 * 2.0 - 0.4 * 0.4 / (2 * 0.5), 1e-9);
}

// At constant speed and turn the path is a circle of radius v / w, and a full turn ends where it began.
TEST(KinematicDrive, ConstantTurnIsACircle) {
  KinematicDrive drive;
  ASSERT_TRUE(drive.start());
  const double v = 0.5, w = 1.0;
  keep_commanding(drive, {v, w}, 0.0, 1.0);
  const Odometry begin = *drive.odometry(at(1.0));
  const double period = 2 * std::numbers::pi / w;
  keep_commanding(drive, {v, w}, 1.0, 1.0 + period / 2);
  const Odometry half = *drive.odometry(at(1.0 + period / 2));
  EXPECT_NEAR(std::hypot(half.x_m - begin.x_m, half.y_m - begin.y_m), 2 * v / w, 1e-3);
  keep_commanding(drive, {v, w}, 1.0 + period / 2, 1.0 + period);
  const Odometry end = *drive.odometry(at(1.0 + period));
  EXPECT_NEAR(std::hypot(end.x_m - begin.x_m, end.y_m - begin.y_m), 0.0, 1e-3);
  EXPECT_NEAR(end.heading_rad - begin.heading_rad, 2 * std::numbers::pi, 2e-3);
}

TEST(KinematicDrive, KeepsItsSpeedUntilTheTimeoutAndSlowsThen) {
  KinematicDrive drive;  // 0.4 s, 1 m/s^2
  ASSERT_TRUE(drive.start());
  keep_commanding(drive, {0.5, 0.0}, 0.0, 1.001);  // the last one at 1.0 s
  EXPECT_NEAR(drive.odometry(at(1.399))->velocity.forward_mps, 0.5, 1e-9);
  EXPECT_NEAR(drive.odometry(at(1.6))->velocity.forward_mps, 0.3, 1.5e-3);
  EXPECT_EQ(drive.odometry(at(1.95))->velocity.forward_mps, 0.0);
}

TEST(KinematicDrive, CutsWhatIsTooFast) {
  KinematicDrive drive;
  ASSERT_TRUE(drive.start());
  keep_commanding(drive, {-100.0, 100.0}, 0.0, 5.0);
  EXPECT_NEAR(drive.odometry(at(5.0))->velocity.forward_mps, -1.5, 1e-9);
  EXPECT_NEAR(drive.odometry(at(5.0))->velocity.left_radps, 3.0, 1e-9);
}

// The same commands at the same times give the same bits, however often somebody looks.
TEST(KinematicDriveProperty, LookingChangesNothing) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> speed(-2.0, 2.0);
  std::uniform_int_distribution<int> pause_us(1, 60'000);
  for (int trial = 0; trial < 50; ++trial) {
    KinematicDrive watched;
    KinematicDrive alone;
    ASSERT_TRUE(watched.start());
    ASSERT_TRUE(alone.start());
    MonoTime now = at(10.0) + std::chrono::microseconds(pause_us(random));
    ASSERT_TRUE(watched.odometry(now - std::chrono::microseconds(300)));
    for (int i = 0; i < 100; ++i) {
      const Twist twist{speed(random), speed(random)};
      ASSERT_TRUE(watched.command(twist, now));
      ASSERT_TRUE(alone.command(twist, now));
      const MonoTime next = now + std::chrono::microseconds(pause_us(random));
      for (; now < next; now += std::chrono::microseconds(777)) ASSERT_TRUE(watched.odometry(now));
      now = next;
    }
    const Odometry a = *watched.odometry(now);
    const Odometry b = *alone.odometry(now);
    ASSERT_EQ(a.stamp, b.stamp);
    ASSERT_EQ(a.x_m, b.x_m);
    ASSERT_EQ(a.y_m, b.y_m);
    ASSERT_EQ(a.heading_rad, b.heading_rad);
    ASSERT_EQ(a.velocity.forward_mps, b.velocity.forward_mps);
  }
}

// Whatever is commanded, speed changes by no more than the limit allows.
TEST(KinematicDriveProperty, AccelerationIsNeverExceeded) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> speed(-3.0, 3.0);
  KinematicDrive drive;
  ASSERT_TRUE(drive.start());
  Odometry last = *drive.odometry(at(0.0));
  for (int i = 1; i < 20'000; ++i) {
    const MonoTime now{std::chrono::milliseconds(5 * i)};
    ASSERT_TRUE(drive.command({speed(random), speed(random)}, now));
    const Odometry here = *drive.odometry(now);
    const double dt = to_seconds(here.stamp - last.stamp);
    ASSERT_LE(std::abs(here.velocity.forward_mps - last.velocity.forward_mps), 1.0 * dt + 1e-9);
    ASSERT_LE(std::abs(here.velocity.left_radps - last.velocity.left_radps), 4.0 * dt + 1e-9);
    last = here;
  }
}

TEST(KinematicDriveFault, EmergencyStopRefusesAndSlowsDown) {
  KinematicDrive drive;
  ASSERT_TRUE(drive.start());
  keep_commanding(drive, {0.5, 0.0}, 0.0, 1.0);
  drive.play(DriveMood::kNotReady);
  const auto commanded = drive.command({0.5, 0.0}, at(1.0));
  ASSERT_FALSE(commanded);
  EXPECT_EQ(commanded.error(), DriveFailure::kNotReady);
  EXPECT_EQ(drive.odometry(at(1.6))->velocity.forward_mps, 0.0);
}

TEST(KinematicDriveFault, ACableThatIsOutFailsCommandsAndStopsTheNews) {
  KinematicDrive drive;
  ASSERT_TRUE(drive.start());
  drive.play(DriveMood::kSendFails);
  EXPECT_EQ(drive.odometry(at(0.0)).error(), DriveFailure::kNoFeedback);
  EXPECT_EQ(drive.odometry(at(0.1)).error(), DriveFailure::kNoFeedback);
  drive.play(DriveMood::kWell);
  keep_commanding(drive, {0.5, 0.0}, 0.1, 1.0);
  ASSERT_EQ(drive.odometry(at(1.0))->stamp, at(1.0));
  drive.play(DriveMood::kSendFails);
  EXPECT_EQ(drive.command({0.5, 0.0}, at(1.1)).error(), DriveFailure::kSendFailed);
  EXPECT_EQ(drive.odometry(at(1.5))->stamp, at(1.0)) << "the newest that was heard, and it says how old it is";
  drive.play(DriveMood::kWell);
  EXPECT_EQ(drive.odometry(at(3.0))->velocity.forward_mps, 0.0) << "without commands it stopped by itself";
}

TEST(KinematicDriveFault, FeedbackThatStopsLeavesCommandsAlone) {
  KinematicDrive drive;
  ASSERT_TRUE(drive.start());
  ASSERT_TRUE(drive.odometry(at(0.0)));
  drive.play(DriveMood::kFeedbackStops);
  keep_commanding(drive, {0.5, 0.0}, 0.0, 1.0);
  EXPECT_EQ(drive.odometry(at(1.0))->stamp, at(0.0));
  drive.play(DriveMood::kWell);
  EXPECT_NEAR(drive.odometry(at(1.0))->velocity.forward_mps, 0.5, 1e-9);
}

TEST(KinematicDrive, RemembersTheLastCommandAndZeroAfterStop) {
  KinematicDrive drive;
  EXPECT_FALSE(drive.last_command());
  ASSERT_TRUE(drive.start());
  EXPECT_FALSE(drive.last_command());
  ASSERT_TRUE(drive.command({0.3, -0.2}, at(0.0)));
  EXPECT_EQ(drive.last_command()->forward_mps, 0.3);
  EXPECT_EQ(drive.last_command()->left_radps, -0.2);
  drive.stop();
  EXPECT_EQ(drive.last_command()->forward_mps, 0.0);
  EXPECT_EQ(drive.last_command()->left_radps, 0.0);
}

TEST(KinematicDrive, HoursOfStandingCostNothing) {
  KinematicDrive drive;
  ASSERT_TRUE(drive.start());
  keep_commanding(drive, {0.5, 0.0}, 0.0, 1.0);
  const double x_m = drive.odometry(at(10.0))->x_m;
  for (int day = 1; day < 10'000; ++day) {
    const Odometry still = *drive.odometry(at(86'400.0 * day));
    ASSERT_EQ(still.x_m, x_m);
    ASSERT_EQ(still.stamp, at(86'400.0 * day));
  }
}

}  // namespace
}  // namespace cgsr::hal
