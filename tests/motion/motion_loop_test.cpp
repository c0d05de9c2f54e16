#include "pipeline/motion/motion_loop.h"

#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/motion/rig.h"

namespace cgsr {
namespace {

TEST(MotionLoop, StartsDisarmedAndStandsStill) {
  Rig rig;
  rig.goal = {0.3, 0.5};
  const auto status = rig.steps(500);
  EXPECT_FALSE(status.armed);
  EXPECT_EQ(status.cause, StopCause::kDisarmed);
  EXPECT_TRUE(status.sent) << "zero is said, not merely meant";
  for (const auto& command : rig.drive->commands) ASSERT_TRUE(is_zero(command));
}

TEST(MotionLoop, ArmsOnRequestAndReachesTheGoalByTheRamp) {
  Rig rig;
  rig.steps(100);
  rig.goal = {0.3, 0.5};
  const auto first = rig.request(ArmRequest::kArm);
  EXPECT_TRUE(first.armed);
  EXPECT_EQ(first.arm_refusal, StopCause::kNone);
  EXPECT_NEAR(first.commanded.forward_mps, 0.4 * 0.01, 1e-12) << "acceleration limit times one cycle";
  EXPECT_NEAR(first.commanded.left_radps, 2.0 * 0.01, 1e-12);

  const auto later = rig.steps(300);
  EXPECT_EQ(later.cause, StopCause::kNone);
  EXPECT_EQ(later.commanded.forward_mps, 0.3);
  EXPECT_EQ(later.commanded.left_radps, 0.5);
  EXPECT_EQ(later.goal.forward_mps, 0.3);
  EXPECT_NEAR(later.odometry.velocity.forward_mps, 0.3, 1e-9);
}

TEST(MotionLoop, SlowerGoalIsApproachedByTheDecelerationLimit) {
  Rig rig;
  rig.arm_and_move({0.3, 0.0});
  rig.goal = {};
  EXPECT_NEAR(rig.step().commanded.forward_mps, 0.3 - 0.8 * 0.01, 1e-12);
  EXPECT_EQ(rig.steps(100).commanded.forward_mps, 0.0);
}

TEST(MotionLoop, WhoeverLostWhatItFollowsHaltsWithoutTheRamp) {
  Rig rig;
  rig.arm_and_move({0.3, 0.0});
  rig.goal = {0.0, 0.4};
  rig.halt = true;
  const auto status = rig.step();
  EXPECT_EQ(status.commanded.forward_mps, 0.0);
  EXPECT_TRUE(status.armed) << "it may go on when it has found it again";
  rig.goal = {0.3, 0.0};
  EXPECT_LE(rig.step().commanded.forward_mps, 0.4 * 0.01 + 1e-12) << "a halt is of a goal that stands";
}

TEST(MotionLoop, DisarmIsZeroAtOnce) {
  Rig rig;
  rig.arm_and_move({0.3, 0.3});
  const auto status = rig.request(ArmRequest::kDisarm);
  EXPECT_FALSE(status.armed);
  EXPECT_TRUE(is_zero(status.commanded));
  EXPECT_TRUE(is_zero(rig.drive->commands.back()));
  EXPECT_EQ(status.cause, StopCause::kDisarmed);
  EXPECT_EQ(status.latched, StopCause::kNone) << "somebody wanted it";
}

TEST(MotionLoop, RefusesToArmWithinTheFirstSecond) {
  Rig rig;
  rig.steps(98);
  const auto refused = rig.request(ArmRequest::kArm);
  EXPECT_FALSE(refused.armed);
  EXPECT_EQ(refused.arm_refusal, StopCause::kLoopLate);
  EXPECT_TRUE(rig.request(ArmRequest::kArm).armed);
}

TEST(MotionLoop, RefusesToArmWhileAnythingStopsIt) {
  Rig rig;
  rig.steps(100);
  rig.inputs.images_in_time = false;
  const auto refused = rig.request(ArmRequest::kArm);
  EXPECT_FALSE(refused.armed);
  EXPECT_EQ(refused.arm_refusal, StopCause::kImagesLate);
  EXPECT_FALSE(rig.step().armed) << "a refused request is not remembered";
}

TEST(MotionLoop, DefaultInputsPermitNothing) {
  Rig rig;
  rig.steps(100);
  MotionInputs silent;
  silent.request = ArmRequest::kArm;
  rig.now += kMotionPeriod;
  EXPECT_FALSE(rig.loop.step(rig.now, silent).armed);
}

TEST(MotionLoop, ArmsItselfOnceWhereTheConfigurationSaysSo) {
  MotionParameters parameters = quick();
  parameters.armed_at_start = true;
  Rig rig(parameters);
  EXPECT_FALSE(rig.steps(99).armed);
  EXPECT_TRUE(rig.step().armed);

  rig.inputs.safety_chain_ok = false;
  EXPECT_FALSE(rig.step().armed);
  rig.inputs.safety_chain_ok = true;
  EXPECT_FALSE(rig.steps(500).armed) << "only once";
}

TEST(MotionLoop, StopBeforeTheFirstArmingCancelsIt) {
  MotionParameters parameters = quick();
  parameters.armed_at_start = true;
  Rig rig(parameters);
  rig.inputs.stop = true;
  rig.step();
  rig.inputs.stop = false;
  EXPECT_FALSE(rig.steps(500).armed);
}

TEST(MotionLoop, DisarmBeforeTheFirstArmingCancelsIt) {
  MotionParameters parameters = quick();
  parameters.armed_at_start = true;
  Rig rig(parameters);
  rig.request(ArmRequest::kDisarm);
  EXPECT_FALSE(rig.steps(500).armed);
}

TEST(MotionLoop, DryRunComputesButNeverCommands) {
  Rig rig({}, MotionLoop::Mode::kDryRun);
  rig.arm_and_move({0.3, 0.2});
  const auto status = rig.step();
  EXPECT_TRUE(status.armed);
  EXPECT_EQ(status.commanded.forward_mps, 0.3);
  EXPECT_FALSE(status.sent);
  EXPECT_TRUE(rig.drive->commands.empty());
}

TEST(MotionLoop, DryRunDoesNotRearmTheBase) {
  Rig<LatchingDrive> rig({}, MotionLoop::Mode::kDryRun);
  rig.arm_and_move({0.3, 0.2});
  EXPECT_EQ(rig.drive->rearms, 0);
}

TEST(MotionLoop, IgnoresAGoalOlderThanTheNewest) {
  Rig rig;
  rig.arm_and_move({0.3, 0.0});
  rig.goals_come = false;
  rig.now += kMotionPeriod;
  auto inputs = rig.inputs;
  inputs.goal = Goal{{-0.3, 0.9}, rig.now - seconds(0.12)};
  const auto status = rig.loop.step(rig.now, inputs);
  EXPECT_EQ(status.goal.forward_mps, 0.3);
  EXPECT_EQ(status.commanded.left_radps, 0.0);
}

TEST(MotionLoop, DoesNotDriveOutOfItsArea) {
  MotionParameters parameters = quick();
  parameters.keep_in.max_x_m = 0.5;
  Rig rig(parameters);
  rig.arm_and_move({0.4, 0.0});
  const auto status = rig.steps(1500);
  EXPECT_EQ(status.cause, StopCause::kNone) << "the area is a limit, not a fault";
  EXPECT_TRUE(status.keep_in_slowed);
  EXPECT_LE(rig.drive->truth.x_m, 0.5);
  EXPECT_GT(rig.drive->truth.x_m, 0.45);

  rig.goal = {0.4, 1.0};
  rig.steps(300);
  EXPECT_GT(rig.drive->truth.heading_rad, 1.0) << "it may always turn";
}

// Where the last odometry was, the robot no longer is.
TEST(MotionLoop, TakesLessNearTheEdgeWhenOdometryGrowsOld) {
  MotionParameters parameters = quick();
  parameters.keep_in.max_x_m = 1.15;
  Rig rig(parameters);
  rig.arm_and_move({0.4, 0.0});
  const auto before = rig.step();
  ASSERT_TRUE(before.keep_in_slowed);
  rig.drive->script.measures = false;
  const auto status = rig.steps(3);
  EXPECT_EQ(status.cause, StopCause::kNone);
  EXPECT_LT(status.commanded.forward_mps, before.commanded.forward_mps - 0.01);
}

TEST(MotionLoop, StopClosesTheBaseAndMayBeCalledTwice) {
  Rig rig;
  rig.arm_and_move({0.3, 0.0});
  rig.loop.stop();
  EXPECT_EQ(rig.drive->stops, 1);
  rig.loop.stop();
  const auto status = rig.step();
  EXPECT_FALSE(status.armed);
}

TEST(MotionLoop, EveryCauseHasItsOwnWords) {
  std::set<std::string_view> words;
  for (int cause = 0; cause <= static_cast<int>(StopCause::kDisarmed); ++cause) {
    words.insert(to_string(static_cast<StopCause>(cause)));
  }
  EXPECT_EQ(words.size(), static_cast<std::size_t>(StopCause::kDisarmed) + 1);
  EXPECT_EQ(words.count("unknown"), 0u);
}

}  // namespace
}  // namespace cgsr
