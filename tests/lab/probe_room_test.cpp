#include "tools/lab/probe_room.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "pipeline/geometry/pose.h"
#include "tools/lab/probe_drive.h"

namespace cgsr::lab {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

TEST(ProbeRoom, OfADrawnHomeHasOneOfItsLampsOn) {
  const auto home = sim::generate_home(660);
  ASSERT_TRUE(home) << home.error().message;
  ASSERT_EQ(home->lights.lamps.size(), 2U);
  const std::size_t last = 1;
  const auto room = ProbeRoom::make(*home, last);
  ASSERT_TRUE(room) << room.error().message;
  const auto& position_m = home->world.lamp[last].position_m;
  EXPECT_EQ((*room)->p_WL(), Eigen::Vector3d(position_m[0], position_m[1], position_m[2]));
  Random random(3);
  const auto below = (*room)->lit_standpoint(20.0 * kDeg, 60.0 * kDeg, random);
  ASSERT_TRUE(below);
  EXPECT_TRUE(std::ranges::none_of((*room)->truth(*below, 1), &sim::ProbeShadow::visible)) << "the other one is off";
}

TEST(ProbeRoom, HasNoFreePlaceInFurnitureWallsOrOutside) {
  const auto room = ProbeRoom::make(ProbeRoomLight{});
  ASSERT_TRUE(room) << room.error().message;
  Random random(3);
  const auto free = (*room)->lit_standpoint(20.0 * kDeg, 60.0 * kDeg, random);
  ASSERT_TRUE(free);
  EXPECT_TRUE((*room)->is_free(*free));
  const auto truth = (*room)->truth(*free);
  EXPECT_TRUE(std::ranges::any_of(truth, &sim::ProbeShadow::visible));
  EXPECT_FALSE((*room)->is_free(sim::pose_at({0.0, 3.0, 0.0}, 0.0))) << "in a wall";
  EXPECT_FALSE((*room)->is_free(sim::pose_at({0.3, 3.0, 0.0}, 0.0))) << "beside it";
  EXPECT_FALSE((*room)->is_free(sim::pose_at({7.15, 3.2, 0.0}, 0.0))) << "in the table";
  EXPECT_FALSE((*room)->is_free(sim::pose_at({7.15 - 0.44 - 0.4 - 0.2, 3.2, 0.0}, 0.0))) << "its board over the table";
  EXPECT_FALSE((*room)->is_free(sim::pose_at({-20.0, 3.0, 0.0}, 0.0))) << "without a floor";
}

// The error of the pose as the judge draws it: as large as it states, the same while the robot stands, another one far away.
TEST(EstimatedPose, ErrsForAsLongAsItIsSaidTo) {
  constexpr int kRuns = 4000;
  constexpr double kNear_m = 0.1;
  constexpr double kFar_m = 15.0;
  double squares = 0.0, near = 0.0, far = 0.0, anew = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const Random random = Random(9).fork(static_cast<std::uint64_t>(run));
    EstimatedPose lasting(DriveErrors::kThatLast, random);
    EstimatedPose white(DriveErrors::kOfEachImage, random);
    const auto error = [](EstimatedPose& pose, double x_m) {
      return pose.at(sim::pose_at({x_m, 0.0, 0.0}, 0.0)).X_WR.translation().x() - x_m;
    };
    const double first = error(lasting, 0.0);
    EXPECT_EQ(error(lasting, 0.0), first) << "it stands";
    near += first * error(lasting, kNear_m);
    far += first * error(lasting, kFar_m);
    squares += first * first;
    anew += error(white, 0.0) * error(white, 0.0);
  }
  EXPECT_NEAR(std::sqrt(squares / kRuns), 0.01, 0.001) << "as stated";
  EXPECT_GT(near / squares, 0.85);
  EXPECT_LT(std::abs(far / squares), 0.15);
  EXPECT_LT(std::abs(anew / squares), 0.15);
}

}  // namespace
}  // namespace cgsr::lab
