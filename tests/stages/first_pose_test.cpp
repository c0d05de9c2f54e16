// A robot that nobody tells where it is: the localize stage asks it to turn on the spot, and its task waits.
#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/stages/tasks.h"
#include "platform/work_budget.h"
#include "tests/stages/turning_robot.h"

namespace cgsr::stages {
namespace {

const std::vector<std::string> kFoundAtOnce = {"first pose: comparing", "first pose: trying", "first pose: settling",
                                               "first pose: found"};

class SeeksFirstPose : public ::testing::Test {
 protected:
  SeeksFirstPose() { robot_.make(robot_.setup()); }

  TurningRobot robot_;
};

TEST_F(SeeksFirstPose, TurnsUntilItKnowsAndLetsItsTaskDriveThen) {
  while (robot_.step().state == "seek_first_pose" && robot_.images < 400) {
    EXPECT_EQ(robot_.frame.decision.value.goal.forward_mps, 0.0);
    EXPECT_FALSE(robot_.pose().known()) << "nobody drives by it";
    EXPECT_EQ(robot_.pose().state(), to_string(robot_.pose().search));
  }
  EXPECT_EQ(robot_.frame.decision.value.state, "ahead");
  EXPECT_EQ(robot_.phases, kFoundAtOnce);
  EXPECT_GT(robot_.turned_rad, 2.0 * std::numbers::pi);
  EXPECT_TRUE(robot_.pose().known());
  EXPECT_LT(robot_.off_m(), 0.03);
  for (int i = 0; i < 5; ++i) robot_.step();
  EXPECT_EQ(robot_.pose().state(), "tracking") << "from there on the pose is carried on";
}

// An image that shows nothing just then does not take it away.
TEST_F(SeeksFirstPose, KeepsThePoseThatItFoundThroughADarkImage) {
  while (robot_.step().state == "seek_first_pose" && robot_.images < 400) {
  }
  ASSERT_EQ(robot_.pose().state(), "tracking");
  robot_.step(true);
  EXPECT_EQ(robot_.pose().state(), "tracking");
  EXPECT_TRUE(robot_.pose().known());
}

TEST_F(SeeksFirstPose, TurnsBackToAViewThatConfirmsWhereThatIsShorter) {
  robot_.X_WR = geometry::pose_on_floor(1.5, 0.8, 3.0);
  double farthest_rad = 0.0;
  while (robot_.step().state == "seek_first_pose" && robot_.images < 400)
    farthest_rad = std::max(farthest_rad, robot_.turned_rad);
  EXPECT_EQ(robot_.phases, kFoundAtOnce);
  EXPECT_LT(robot_.off_m(), 0.04);
  EXPECT_LT(robot_.turned_rad, farthest_rad - 0.3);
}

// What it looks at of the turn does not move with the robot of now, although the localizer searches for many images.
TEST_F(SeeksFirstPose, FindsItWhileItBalances) {
  robot_.lean_rad = 1.0 / 57.3;
  robot_.units = 18;
  while (robot_.step().state == "seek_first_pose" && robot_.images < 600) {
  }
  EXPECT_LT(robot_.images, 300) << "views are lost: they move along with the robot";
  EXPECT_EQ(robot_.phases, kFoundAtOnce);
  EXPECT_LT(robot_.off_m(), 0.04);
}

TEST_F(SeeksFirstPose, GivesUpAndStandsAfterSomeTurnsInTheDark) {
  while (robot_.phases.size() < 20 && robot_.images < 600) robot_.step(true);
  EXPECT_EQ(std::ranges::count(robot_.phases, "first pose: not_found"), LocalizeStage::kMaxTurns);
  EXPECT_EQ(robot_.frame.decision.value.goal.left_radps, 0.0);
  EXPECT_EQ(robot_.frame.decision.value.state, "seek_first_pose") << "its task does not drive";
  EXPECT_LT(robot_.turned_rad, 2.5 * std::numbers::pi * LocalizeStage::kMaxTurns);
}

// Where the pose stage is late the robot stops.
TEST_F(SeeksFirstPose, StandsWhileTheSearchIsNotHeardOf) {
  robot_.step();
  ASSERT_GT(robot_.step().goal.left_radps, 0.0);
  robot_.frame.pose.age = kMaxPoseAge + Duration(1);
  const Decision decision = robot_.decide().update(ImageLease(), robot_.frame);
  EXPECT_EQ(decision.goal.left_radps, 0.0);
  EXPECT_EQ(decision.state, "seek_first_pose");
}

// Nor does its task drive because of an image that could not be reduced.
TEST_F(SeeksFirstPose, GoesOnAfterAnImageWithoutAView) {
  robot_.step();
  UnlimitedBudget whole;
  robot_.frame.view = {};
  robot_.frame.pose = {robot_.localize().update(whole, {}, robot_.frame.view, hal::Odometry{}), {}, Duration::zero()};
  EXPECT_EQ(robot_.decide().update(ImageLease(), robot_.frame).state, "seek_first_pose");
}

}  // namespace
}  // namespace cgsr::stages
