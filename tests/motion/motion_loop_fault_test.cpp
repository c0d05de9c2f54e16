// One test for each row of docs/faults.md that the motion loop answers.

#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "pipeline/motion/motion_loop.h"
#include "tests/motion/rig.h"

namespace cgsr {
namespace {

/// Steps until zero is commanded. \return the time from `since` to that command.
template <class AnyRig>
double seconds_to_zero(AnyRig& rig, MonoTime since, MotionStatus& status) {
  for (int i = 0; i < 100; ++i) {
    status = rig.step();
    if (is_zero(rig.drive->commands.back())) return to_seconds(rig.now - since);
  }
  return std::numeric_limits<double>::infinity();
}

TEST(MotionLoopFault, GoalStale) {
  Rig rig;
  rig.arm_and_move({0.3, 0.2});
  rig.goals_come = false;
  const MonoTime last_stamp = rig.now - seconds(0.033);
  MotionStatus status;
  const double silence_s = seconds_to_zero(rig, last_stamp, status);
  EXPECT_GT(silence_s, 0.150) << "not before";
  EXPECT_LE(silence_s, 0.160 + 1e-9) << "150 ms of stamp time and one cycle";
  EXPECT_EQ(status.cause, StopCause::kGoalStale);
  EXPECT_TRUE(status.armed);

  rig.goals_come = true;
  const auto resumed = rig.step();
  EXPECT_EQ(resumed.cause, StopCause::kNone);
  EXPECT_NEAR(resumed.commanded.forward_mps, 0.4 * 0.01, 1e-12) << "from zero, by the ramp";
}

TEST(MotionLoopFault, NoGoalYet) {
  Rig rig;
  rig.goals_come = false;
  rig.steps(100);
  const auto status = rig.request(ArmRequest::kArm);
  EXPECT_EQ(status.arm_refusal, StopCause::kNoGoal);
  EXPECT_FALSE(status.armed);
}

TEST(MotionLoopFault, HeldTooLongDisarms) {
  Rig rig;
  rig.arm_and_move({0.3, 0.0});
  rig.inputs.images_in_time = false;
  EXPECT_TRUE(rig.steps(200).armed) << "two seconds are let pass";
  const auto status = rig.steps(2);
  EXPECT_FALSE(status.armed);
  EXPECT_EQ(status.latched, StopCause::kHeldTooLong);

  rig.inputs.images_in_time = true;
  EXPECT_TRUE(is_zero(rig.steps(200).commanded));
  EXPECT_TRUE(rig.request(ArmRequest::kArm).armed);
  EXPECT_EQ(rig.step().latched, StopCause::kNone);
}

TEST(MotionLoopFault, ImagesLate) {
  Rig rig;
  rig.arm_and_move({0.3, 0.2});
  rig.inputs.images_in_time = false;
  auto status = rig.step();
  EXPECT_TRUE(is_zero(rig.drive->commands.back())) << "in the same control cycle";
  EXPECT_EQ(status.cause, StopCause::kImagesLate);
  rig.inputs.images_in_time = true;
  status = rig.step();
  EXPECT_GT(status.commanded.forward_mps, 0.0) << "a passing cause";
}

TEST(MotionLoopFault, FeedbackStale) {
  Rig rig;
  rig.arm_and_move({0.3, 0.2});
  rig.drive->script.measures = false;
  const MonoTime last_stamp = rig.now;
  MotionStatus status;
  const double silence_s = seconds_to_zero(rig, last_stamp, status);
  EXPECT_GT(silence_s, 0.100);
  EXPECT_LE(silence_s, 0.110 + 1e-9);
  EXPECT_EQ(status.cause, StopCause::kFeedbackStale);
  EXPECT_EQ(status.latched, StopCause::kFeedbackStale);
  EXPECT_FALSE(status.armed);
}

/// A cause that stops the robot in the cycle in which it is seen, disarms it, and lets it be armed again once it is over.
template <class AnyRig>
void expect_latches(AnyRig& rig, StopCause cause, const std::function<void(bool)>& set) {
  rig.arm_and_move({0.3, 0.2});
  set(true);
  auto status = rig.step();
  EXPECT_TRUE(is_zero(status.commanded));
  EXPECT_EQ(status.cause, cause);
  EXPECT_EQ(status.latched, cause);
  EXPECT_FALSE(status.armed);
  EXPECT_EQ(rig.request(ArmRequest::kArm).arm_refusal, cause);

  set(false);
  status = rig.steps(200);
  EXPECT_FALSE(status.armed) << "does not arm itself";
  EXPECT_EQ(status.cause, StopCause::kDisarmed);
  EXPECT_EQ(status.latched, cause) << "still says why";
  EXPECT_TRUE(is_zero(rig.drive->commands.back()));

  status = rig.request(ArmRequest::kArm);
  EXPECT_TRUE(status.armed);
  EXPECT_EQ(status.latched, StopCause::kNone);
}

TEST(MotionLoopFault, StopRequested) {
  Rig rig;
  expect_latches(rig, StopCause::kStopRequested, [&](bool on) { rig.inputs.stop = on; });
}

TEST(MotionLoopFault, SafetyChain) {
  Rig rig;
  expect_latches(rig, StopCause::kSafetyFault, [&](bool on) { rig.inputs.safety_chain_ok = !on; });
}

TEST(MotionLoopFault, DriveNotReady) {
  Rig rig;
  expect_latches(rig, StopCause::kDriveNotReady, [&](bool on) {
    rig.drive->script.ready = !on;
    if (on) rig.drive->stop();  // an emergency stop cuts the motors
  });
}

TEST(MotionLoopFault, CommandNotSent) {
  Rig rig;
  expect_latches(rig, StopCause::kDriveFailed, [&](bool on) { rig.drive->script.sends = !on; });
}

TEST(MotionLoopFault, NoFeedbackAtAll) {
  Rig rig;
  expect_latches(rig, StopCause::kFeedbackStale, [&](bool on) { rig.drive->script.reports = !on; });
}

TEST(MotionLoopFault, FeedbackIsNotANumber) {
  Rig rig;
  expect_latches(rig, StopCause::kFeedbackStale, [&](bool on) { rig.drive->script.finite = !on; });
  Rig other;
  expect_latches(other, StopCause::kFeedbackStale, [&](bool on) { other.drive->script.finite_speed = !on; });
}

TEST(MotionLoopFault, FeedbackFromTheFuture) {
  Rig rig;
  expect_latches(rig, StopCause::kFeedbackStale, [&](bool on) { rig.drive->script.from_the_past = !on; });
}

TEST(MotionLoopFault, BaseSaysItHasAFault) {
  Rig<LatchingDrive> rig;
  expect_latches(rig, StopCause::kDriveNotReady, [&](bool on) {
    rig.drive->standing = on ? hal::DriveFault::kEmergencyStop : hal::DriveFault::kNone;
    if (on) rig.drive->latched = hal::DriveFault::kEmergencyStop;
    if (on) rig.drive->stop();
  });
  EXPECT_EQ(rig.drive->latched, hal::DriveFault::kNone) << "arming re-armed the base";
}

TEST(MotionLoopFault, BaseFaultIsSeenWhileItStands) {
  Rig<LatchingDrive> rig;
  rig.arm_and_move({});
  rig.drive->latched = hal::DriveFault::kBusOff;  // zero would still be taken
  const auto status = rig.step();
  EXPECT_FALSE(status.armed);
  EXPECT_EQ(status.cause, StopCause::kDriveFailed);
  EXPECT_EQ(status.drive_fault, hal::DriveFault::kBusOff);
}

TEST(MotionLoopFault, BaseRefusesToRearm) {
  Rig<LatchingDrive> rig;
  rig.steps(100);
  rig.drive->latched = hal::DriveFault::kEmergencyStop;
  EXPECT_TRUE(rig.request(ArmRequest::kArm).armed) << "nothing in the way any more";

  Rig<LatchingDrive> other;
  other.steps(100);
  other.drive->standing = hal::DriveFault::kEmergencyStop;
  const auto status = other.request(ArmRequest::kArm);
  EXPECT_FALSE(status.armed);
  EXPECT_EQ(status.arm_refusal, StopCause::kDriveNotReady);
}

TEST(MotionLoopFault, GoalIsNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const hal::Twist bad :
       {hal::Twist{nan, 0.0}, hal::Twist{0.0, nan}, hal::Twist{infinity, 0.0}, hal::Twist{0.1, -infinity}}) {
    Rig rig;
    expect_latches(rig, StopCause::kBadGoal, [&](bool on) { rig.goal = on ? bad : hal::Twist{0.3, 0.2}; });
  }
}

TEST(MotionLoopFault, BadGoalIsForgotten) {
  Rig rig;
  rig.steps(200);
  rig.goal.forward_mps = std::numeric_limits<double>::quiet_NaN();
  rig.step();
  rig.goals_come = false;
  EXPECT_EQ(rig.request(ArmRequest::kArm).arm_refusal, StopCause::kNoGoal) << "and the good one before it too";
}

TEST(MotionLoopFault, ZeroIsTriedAgainWhenACommandDidNotLeave) {
  Rig rig;
  rig.arm_and_move({0.3, 0.2});
  rig.drive->script.sends_fail_next = 1;
  const auto status = rig.step();
  EXPECT_TRUE(is_zero(rig.drive->commands.back())) << "in the same control cycle";
  EXPECT_EQ(status.cause, StopCause::kDriveFailed);
  EXPECT_FALSE(status.sent);
  EXPECT_FALSE(status.armed);
}

TEST(MotionLoopFault, GoalFromTheFuture) {
  Rig rig;
  rig.arm_and_move({0.3, 0.2});
  rig.now += kMotionPeriod;
  auto inputs = rig.inputs;
  inputs.goal = Goal{{0.3, 0.2}, rig.now + Duration(1)};
  const auto status = rig.loop.step(rig.now, inputs);
  EXPECT_TRUE(is_zero(status.commanded));
  EXPECT_EQ(status.latched, StopCause::kBadGoal);
}

TEST(MotionLoopFault, LateLoopIsCountedAndNotArmed) {
  Rig rig;
  rig.steps(200);
  EXPECT_FALSE(rig.step(seconds(0.020)).late);
  EXPECT_TRUE(rig.step(seconds(0.021)).late);
  EXPECT_EQ(rig.request(ArmRequest::kArm).arm_refusal, StopCause::kLoopLate);
  rig.steps(98);
  EXPECT_TRUE(rig.request(ArmRequest::kArm).armed) << "a second later";
}

TEST(MotionLoopFault, LateCycleIsNoJumpOfSpeed) {
  Rig rig;
  rig.arm_and_move({});
  rig.goal = {0.4, 1.0};
  const auto status = rig.step(seconds(0.1));
  EXPECT_LE(status.commanded.forward_mps, 0.4 * 0.020 + 1e-12);
  EXPECT_LE(status.commanded.left_radps, 2.0 * 0.020 + 1e-12);
}

TEST(MotionLoopFault, TimeStandsStillOrRunsBack) {
  Rig rig;
  rig.arm_and_move({});
  rig.goal = {0.4, 1.0};
  EXPECT_TRUE(rig.step(Duration::zero()).late);
  EXPECT_TRUE(is_zero(rig.step(Duration::zero()).commanded));
}

}  // namespace
}  // namespace cgsr
