// A robot that is lost for long, as one that was carried elsewhere: it searches the whole map again by itself.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/stages/turning_robot.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::stages {
namespace {

constexpr double kAgain_s = 3.0;
constexpr int kImagesUntilAgain = static_cast<int>(kAgain_s / TurningRobot::kImage_s);
const geometry::Pose kBegin = geometry::pose_on_floor(0.9, 1.7, 0.3);
const geometry::Pose kElsewhere = geometry::pose_on_floor(2.6, 2.3, 2.9);

class SeeksAgain : public ::testing::Test {
 protected:
  /// Begins where it is told to be.
  void begin(double again_s, bool anywhere = true) {
    robot_.X_WR = kBegin;
    LocalizationSetup setup = robot_.setup();
    setup.seeks_first_pose = false;
    setup.seek_again_after = seconds(again_s);
    if (!anywhere) setup.places_m.clear();
    robot_.make(std::move(setup));
    for (int i = 0; i < 5; ++i) robot_.step();
    ASSERT_EQ(robot_.pose().state(), "tracking");
  }

  /// \return images until it seeks its pose anew; nothing: it does not within so many.
  std::optional<int> images_until_it_seeks(int most, bool dark = false) {
    for (int i = 1; i <= most; ++i) {
      robot_.step(dark);
      if (robot_.pose().seeks_pose()) return i;
    }
    return std::nullopt;
  }

  void be_lost(const geometry::Pose& X_WR = kElsewhere) {
    robot_.X_WR = X_WR;
    for (int i = 0; i < 60 && robot_.pose().state() != "lost"; ++i) robot_.step();
    ASSERT_EQ(robot_.pose().state(), "lost");
  }

  /// Until the search ends.
  void seek(bool dark = false) {
    for (int i = 0; i < 600 && robot_.pose().seeks_pose(); ++i) {
      EXPECT_EQ(robot_.frame.decision.value.state, "seek_new_pose");
      EXPECT_EQ(robot_.frame.decision.value.goal.forward_mps, 0.0);
      EXPECT_FALSE(robot_.pose().known()) << "nobody drives by it";
      robot_.step(dark);
    }
    ASSERT_FALSE(robot_.pose().seeks_pose());
  }

  TurningRobot robot_;
};

TEST_F(SeeksAgain, ARobotThatFoundItselfAndWasCarriedFindsItselfElsewhere) {
  LocalizationSetup setup = robot_.setup();
  setup.seek_again_after = seconds(kAgain_s);
  robot_.make(std::move(setup));
  while (robot_.step().state == "seek_first_pose" && robot_.images < 400) {
  }
  ASSERT_TRUE(robot_.pose().known());
  robot_.phases.clear();

  be_lost();
  EXPECT_GE(images_until_it_seeks(3 * kImagesUntilAgain).value_or(0), kImagesUntilAgain - 1);
  seek();
  EXPECT_EQ(robot_.phases, (std::vector<std::string>{"new pose: turning", "new pose: comparing", "new pose: trying",
                                                     "new pose: settling", "new pose: found"}));
  EXPECT_EQ(robot_.frame.decision.value.state, "ahead") << "its task goes on";
  EXPECT_TRUE(robot_.pose().known());
  EXPECT_LT(robot_.off_m(), 0.03);
  for (int i = 0; i < 5; ++i) robot_.step();
  EXPECT_EQ(robot_.pose().state(), "tracking");
  EXPECT_LT(robot_.off_m(), 0.03);
}

// A second search has nothing of the first one left.
TEST_F(SeeksAgain, ARobotThatIsCarriedTwiceFindsItselfTwice) {
  begin(kAgain_s);
  for (const geometry::Pose& X_WR : {kElsewhere, kBegin}) {
    be_lost(X_WR);
    ASSERT_TRUE(images_until_it_seeks(3 * kImagesUntilAgain));
    seek();
    EXPECT_TRUE(robot_.pose().known());
    EXPECT_LT(robot_.off_m(), 0.03);
  }
}

TEST_F(SeeksAgain, DarknessAloneDoesNotStartIt) {
  begin(kAgain_s);
  EXPECT_FALSE(images_until_it_seeks(6 * kImagesUntilAgain, true));
  EXPECT_EQ(robot_.pose().state(), "lost");
  EXPECT_EQ(robot_.turned_rad, 0.0);
  robot_.X_WR = kElsewhere;
  EXPECT_GE(images_until_it_seeks(3 * kImagesUntilAgain).value_or(0), kImagesUntilAgain)
      << "the time in the dark counted";
}

TEST_F(SeeksAgain, ALightThatComesBackEndsTheLossWithoutATurn) {
  begin(kAgain_s);
  EXPECT_FALSE(images_until_it_seeks(6 * kImagesUntilAgain, true));
  EXPECT_FALSE(images_until_it_seeks(2 * kImagesUntilAgain));
  EXPECT_EQ(robot_.pose().state(), "tracking");
  EXPECT_EQ(robot_.turned_rad, 0.0);
}

TEST_F(SeeksAgain, NeverAfterZeroSeconds) {
  begin(0.0);
  be_lost();
  EXPECT_FALSE(images_until_it_seeks(4 * kImagesUntilAgain));
  EXPECT_EQ(robot_.frame.decision.value.state, "ahead");
}

TEST_F(SeeksAgain, NeverARobotThatMayNotBeAnywhere) {
  begin(kAgain_s, false);
  be_lost();
  EXPECT_FALSE(images_until_it_seeks(4 * kImagesUntilAgain));
}

// The light goes out as it turns: after the last turn it is as lost as before, where it was, and does not begin again.
TEST_F(SeeksAgain, GoesOnAsLostAsBeforeAfterSomeTurnsInTheDark) {
  begin(kAgain_s);
  be_lost();
  ASSERT_TRUE(images_until_it_seeks(3 * kImagesUntilAgain));
  seek(true);
  EXPECT_EQ(std::ranges::count(robot_.phases, "new pose: not_found"), LocalizeStage::kMaxTurns);
  EXPECT_EQ(robot_.pose().state(), "lost");
  EXPECT_FALSE(robot_.pose().known());
  EXPECT_EQ(robot_.frame.decision.value.state, "ahead") << "its task goes on without a pose, as without a search";
  EXPECT_FALSE(images_until_it_seeks(4 * kImagesUntilAgain)) << "it turns for ever";

  // Carried back, and as the odometry says turned since.
  robot_.X_WR = kBegin * geometry::pose_on_floor(0.0, 0.0, robot_.turned_rad);
  for (int i = 0; i < 20 && robot_.pose().state() != "tracking"; ++i) robot_.step();
  EXPECT_EQ(robot_.pose().state(), "tracking") << "the lost pose did not turn along with the robot";
  EXPECT_LT(robot_.off_m(), 0.03);
  be_lost();
  EXPECT_TRUE(images_until_it_seeks(3 * kImagesUntilAgain)) << "a loss that comes after a correction is a new one";
}

TEST_F(SeeksAgain, AllocatesNothing) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  begin(kAgain_s);
  be_lost();
  ASSERT_TRUE(images_until_it_seeks(3 * kImagesUntilAgain));
  seek();
  robot_.step();
  EXPECT_EQ(robot_.allocations, 0U);
}

}  // namespace
}  // namespace cgsr::stages
