#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "hal/drive.h"
#include "tests/hal/case_name.h"

namespace cgsr::hal {

/// One base to be held to the contract of hal/drive.h.
struct DriveRig {
  std::shared_ptr<void> world;  ///< whatever must outlive the base: a bus, a simulated Segway.
  std::unique_ptr<Drive> drive;
  std::function<void(MonoTime)> run_to = [](MonoTime) {};  ///< lets the world go on until then.
};

struct DriveCase {
  std::string name;
  std::function<DriveRig()> make;
  friend void PrintTo(const DriveCase& one, std::ostream* out) { *out << one.name; }
};

/// The suite. A test program that includes this header adds an implementation with one line:
///   INSTANTIATE_TEST_SUITE_P(Rmp, DriveContract, testing::Values(DriveCase{"virtual_bus", make_rmp}), CaseName());
class DriveContract : public testing::TestWithParam<DriveCase> {
 protected:
  void SetUp() override {
    rig_ = GetParam().make();
    ASSERT_TRUE(rig_.drive);
  }

  Drive& drive() { return *rig_.drive; }

  void wait(double s) {
    now_ += seconds(s);
    rig_.run_to(now_);
  }

  // Commands every 20 ms for `s`, as a motion loop does. \return whether every command was taken.
  bool command_for(const Twist& twist, double s) {
    bool all = true;
    for (double t = 0; t < s - 0.001; t += 0.02) {
      all = drive().command(twist, now_).has_value() && all;
      wait(0.02);
    }
    return all;
  }

  Odometry odometry() {
    const auto heard = drive().odometry(now_);
    EXPECT_TRUE(heard) << (heard ? "" : to_string(heard.error()));
    if (!heard) return {};
    EXPECT_LE(heard->stamp, now_);
    EXPECT_GE(heard->stamp, now_ - seconds(0.1)) << "odometry is older than 100 ms";
    return *heard;
  }

  void start() {
    const auto started = drive().start();
    ASSERT_TRUE(started) << started.error().message;
    wait(0.2);  // a real base needs a moment to be heard
  }

  DriveRig rig_;
  MonoTime now_{seconds(1000.0)};
};

TEST_P(DriveContract, BeforeStartEverythingIsRefused) {
  const auto commanded = drive().command({0.1, 0.0}, now_);
  ASSERT_FALSE(commanded);
  EXPECT_EQ(commanded.error(), DriveFailure::kNotStarted);
  const auto heard = drive().odometry(now_);
  ASSERT_FALSE(heard);
  EXPECT_EQ(heard.error(), DriveFailure::kNotStarted);
}

TEST_P(DriveContract, StartingTwiceIsAnError) {
  start();
  const auto again = drive().start();
  ASSERT_FALSE(again);
  EXPECT_FALSE(again.error().message.empty());
}

TEST_P(DriveContract, StandsStillUntilTheFirstCommand) {
  start();
  wait(2.0);
  const Odometry still = odometry();
  EXPECT_NEAR(still.x_m, 0.0, 0.01);
  EXPECT_NEAR(still.y_m, 0.0, 0.01);
  EXPECT_NEAR(still.velocity.forward_mps, 0.0, 0.01);
}

TEST_P(DriveContract, ForwardIsAlongX) {
  start();
  ASSERT_TRUE(command_for({0.3, 0.0}, 3.0));
  const Odometry there = odometry();
  EXPECT_GT(there.x_m, 0.4);
  EXPECT_LT(there.x_m, 1.0);
  EXPECT_NEAR(there.y_m, 0.0, 0.05);
  EXPECT_NEAR(there.velocity.forward_mps, 0.3, 0.05);
}

TEST_P(DriveContract, LeftIsCounterClockwise) {
  start();
  ASSERT_TRUE(command_for({0.0, 0.5}, 2.0));
  const Odometry there = odometry();
  EXPECT_GT(there.heading_rad, 0.5);
  EXPECT_LT(there.heading_rad, 1.1);
  EXPECT_NEAR(there.velocity.left_radps, 0.5, 0.1);
  EXPECT_NEAR(std::hypot(there.x_m, there.y_m), 0.0, 0.05);
}

// Forward and then left: the robot stands ahead of where it began, on its left side.
TEST_P(DriveContract, ALeftCurveEndsAtPositiveY) {
  start();
  ASSERT_TRUE(command_for({0.3, 0.4}, 3.0));
  const Odometry there = odometry();
  EXPECT_GT(there.y_m, 0.1);
  EXPECT_GT(there.x_m, 0.1);
}

TEST_P(DriveContract, ZeroStopsIt) {
  start();
  ASSERT_TRUE(command_for({0.4, 0.3}, 2.0));
  ASSERT_TRUE(command_for({0.0, 0.0}, 2.0));
  EXPECT_NEAR(odometry().velocity.forward_mps, 0.0, 0.02);
  EXPECT_NEAR(odometry().velocity.left_radps, 0.0, 0.02);
}

TEST_P(DriveContract, StopsByItselfWhenCommandsCease) {
  start();
  ASSERT_TRUE(command_for({0.4, 0.0}, 2.0));
  wait(0.5 + 1.5);  // the timeout, and a slow ramp
  const double x_m = odometry().x_m;
  EXPECT_NEAR(odometry().velocity.forward_mps, 0.0, 0.02);
  wait(1.0);
  EXPECT_NEAR(odometry().x_m, x_m, 0.01);
}

TEST_P(DriveContract, NonFiniteCommandsAreRefusedAndChangeNothing) {
  start();
  ASSERT_TRUE(command_for({0.3, 0.0}, 2.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Twist& twist : {Twist{nan, 0.0}, Twist{0.0, nan}, Twist{infinity, 0.0}, Twist{0.0, -infinity}}) {
    const auto commanded = drive().command(twist, now_);
    ASSERT_FALSE(commanded);
    EXPECT_EQ(commanded.error(), DriveFailure::kSendFailed);
  }
  wait(0.1);
  EXPECT_NEAR(odometry().velocity.forward_mps, 0.3, 0.05);
  wait(2.0);
  EXPECT_NEAR(odometry().velocity.forward_mps, 0.0, 0.02) << "a refused command must not keep the base alive";
}

TEST_P(DriveContract, StampsOfOdometryNeverFall) {
  start();
  MonoTime last = MonoTime::min();
  for (int i = 0; i < 50; ++i) {
    (void)drive().command({0.2, 0.1}, now_);
    wait(0.01);
    const MonoTime stamp = odometry().stamp;
    EXPECT_GE(stamp, last);
    last = stamp;
  }
}

TEST_P(DriveContract, StopIsIdempotentAndStartBeginsAnew) {
  start();
  ASSERT_TRUE(command_for({0.4, 0.2}, 1.0));
  drive().stop();
  drive().stop();
  const auto commanded = drive().command({0.1, 0.0}, now_);
  ASSERT_FALSE(commanded);
  EXPECT_EQ(commanded.error(), DriveFailure::kNotStarted);
  wait(3.0);
  start();
  EXPECT_NEAR(odometry().x_m, 0.0, 0.01);
  EXPECT_NEAR(odometry().velocity.forward_mps, 0.0, 0.02);
}

}  // namespace cgsr::hal
