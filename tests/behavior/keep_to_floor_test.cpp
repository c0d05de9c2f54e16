#include "pipeline/behavior/keep_to_floor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/behavior/two_rooms.h"

namespace cgsr::behavior {
namespace {

constexpr double kBrakes_mps2 = 0.6, kClearance_m = 0.4;

class KeepToFloor : public testing::Test {
 protected:
  const FreeFloor floor_{test::two_rooms(), {.min_clearance_m = kClearance_m}};
};

TEST_F(KeepToFloor, LeavesWhatHasRoomEnough) {
  const Velocity wanted{0.5, 0.3};
  const Velocity kept = keep_to_floor(floor_, {true, 3.0, 1.0, std::numbers::pi}, wanted, kBrakes_mps2);
  EXPECT_EQ(kept.forward_mps, 0.5);
  EXPECT_EQ(kept.left_radps, 0.3);
}

// A robot that does what it may, and brakes no harder than it can, comes to stand before the wall at x = 0, forwards as backwards.
TEST_F(KeepToFloor, StopsBeforeAWall) {
  constexpr double kStep_s = 0.033;
  for (const double forward_mps : {0.5, -0.5}) {
    PlanarPose here{true, 1.5, 1.0, forward_mps > 0.0 ? std::numbers::pi : 0.0};
    double speed_mps = 0.0;
    for (int image = 0; image < 600; ++image) {
      const Velocity kept = keep_to_floor(floor_, here, {forward_mps, 0.0}, kBrakes_mps2);
      speed_mps = std::max(std::abs(kept.forward_mps), speed_mps - kBrakes_mps2 * kStep_s);  // no base brakes harder
      here.x_m -= speed_mps * kStep_s;
    }
    EXPECT_GT(here.x_m, kClearance_m);
    EXPECT_LT(here.x_m, kClearance_m + 0.15);
    EXPECT_NEAR(speed_mps, 0.0, 0.01);
    EXPECT_EQ(keep_to_floor(floor_, here, {0.0, 0.4}, kBrakes_mps2).left_radps, 0.4) << "it may turn";
  }
}

TEST_F(KeepToFloor, ChangesNoSpeedWhereThereIsRoom) {
  for (double mps = 0.01; mps < 1.0; mps += 0.013)
    EXPECT_EQ(keep_to_floor(floor_, {true, 3.0, 1.0, std::numbers::pi}, {mps, 0.0}, kBrakes_mps2).forward_mps, mps);
}

// Armed too near to the wall at x = 0.
TEST_F(KeepToFloor, LetsTheRobotBackOntoTheFloor) {
  const PlanarPose at_the_wall{true, 0.25, 1.0, std::numbers::pi};
  EXPECT_EQ(keep_to_floor(floor_, at_the_wall, {0.3, 0.0}, kBrakes_mps2).forward_mps, 0.0);
  const double back_mps = keep_to_floor(floor_, at_the_wall, {-0.3, 0.0}, kBrakes_mps2).forward_mps;
  EXPECT_LT(back_mps, 0.0);
  EXPECT_GE(back_mps, -0.1);
  EXPECT_EQ(keep_to_floor(floor_, {true, -2.0, 1.0, 0.0}, {0.3, 0.0}, kBrakes_mps2).forward_mps, 0.0) << "off the map";
}

TEST_F(KeepToFloor, KnowsNothingWithoutAPose) {
  EXPECT_EQ(keep_to_floor(floor_, {false, 0.1, 1.0, std::numbers::pi}, {0.5, 0.0}, kBrakes_mps2).forward_mps, 0.5);
}

}  // namespace
}  // namespace cgsr::behavior
