#include "pipeline/motion/motion_limits.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace cgsr {
namespace {

constexpr double kPi = std::numbers::pi;

hal::Odometry at(double x_m, double y_m, double heading_rad) {
  hal::Odometry pose;
  pose.x_m = x_m;
  pose.y_m = y_m;
  pose.heading_rad = heading_rad;
  return pose;
}

MotionParameters with_reaction(double reaction_s) {
  MotionParameters limits;
  limits.reaction_s = reaction_s;
  limits.max_backward_mps = 0.4;
  return limits;
}

TEST(MotionClamp, KeepsEveryGoalWithinTheLimits) {
  const MotionParameters limits;
  EXPECT_EQ(clamp({9.0, 9.0}, limits).forward_mps, limits.max_forward_mps);
  EXPECT_EQ(clamp({9.0, 9.0}, limits).left_radps, limits.max_turn_radps);
  EXPECT_EQ(clamp({-9.0, -9.0}, limits).left_radps, -limits.max_turn_radps);
  EXPECT_EQ(clamp({-9.0, 0.0}, limits).forward_mps, 0.0) << "it is blind backwards";
  EXPECT_EQ(clamp({0.1, -0.2}, limits).forward_mps, 0.1);
  EXPECT_EQ(clamp({0.1, -0.2}, limits).left_radps, -0.2);
}

TEST(KeepIn, LeavesSpeedAloneFarFromTheEdge) {
  const auto limits = with_reaction(0.2);
  EXPECT_EQ(speed_within_area(0.4, at(0.0, 0.0, 0.0), 0.0, limits), 0.4);
  EXPECT_EQ(speed_within_area(-0.4, at(0.0, 0.0, 0.0), 0.0, limits), -0.4);
}

// v t + v^2 / (2 a) of the answer is the way that is left.
TEST(KeepIn, StopsExactlyAtTheEdge) {
  for (const double reaction_s : {0.0, 0.2}) {
    const auto limits = with_reaction(reaction_s);
    for (const double way_m : {0.001, 0.02, 0.05, 0.1}) {
      const double v = speed_within_area(0.4, at(limits.keep_in.max_x_m - way_m, 0.0, 0.0), 0.01, limits);
      ASSERT_LT(v, 0.4);
      EXPECT_NEAR(v * (reaction_s + 0.01) + v * v / (2.0 * limits.max_deceleration_mps2), way_m, 1e-12);
    }
  }
}

TEST(KeepIn, KnowsAllFourEdgesAndBothDirections) {
  const auto limits = with_reaction(0.2);
  const double edge = 5.0;
  EXPECT_EQ(speed_within_area(0.4, at(edge, 0.0, 0.0), 0.0, limits), 0.0);
  EXPECT_EQ(speed_within_area(0.4, at(0.0, edge, kPi / 2), 0.0, limits), 0.0);
  EXPECT_EQ(speed_within_area(0.4, at(-edge, 0.0, kPi), 0.0, limits), 0.0);
  EXPECT_EQ(speed_within_area(0.4, at(0.0, -edge, -kPi / 2), 0.0, limits), 0.0);
  EXPECT_EQ(speed_within_area(-0.4, at(-edge, 0.0, 0.0), 0.0, limits), 0.0) << "backwards out";
  EXPECT_EQ(speed_within_area(-0.4, at(edge, 0.0, 0.0), 0.0, limits), -0.4) << "backwards in";
  EXPECT_EQ(speed_within_area(0.4, at(edge, 0.0, 40.0 * kPi), 0.0, limits), 0.0) << "many turns later";
}

TEST(KeepIn, OutsideOnlyTheWayBackIsOpen) {
  const auto limits = with_reaction(0.2);
  EXPECT_EQ(speed_within_area(0.4, at(5.5, 0.0, 0.0), 0.0, limits), 0.0);
  EXPECT_EQ(speed_within_area(0.4, at(5.5, 0.0, 0.4 * kPi), 0.0, limits), 0.0) << "still outwards";
  EXPECT_EQ(speed_within_area(0.4, at(5.5, 0.0, kPi), 0.0, limits), 0.4);
}

// It is not known yet that it will turn; it could.
TEST(KeepIn, IsReadyForATurnTowardsTheEdge) {
  auto limits = with_reaction(0.2);
  const auto along_the_edge = at(0.0, 4.99, 0.0);
  EXPECT_LT(speed_within_area(0.4, along_the_edge, 0.0, limits), 0.1);
  EXPECT_EQ(speed_within_area(0.4, at(0.0, 4.8, 0.0), 0.0, limits), 0.4);

  limits.reaction_s = 1.0;
  limits.max_deceleration_mps2 = 3.0;
  EXPECT_LT(speed_within_area(0.4, at(0.0, 4.9, 0.0), 0.0, limits), 0.2) << "it turns during the reaction too";

  limits.max_turn_radps = 0.0;
  EXPECT_EQ(speed_within_area(0.4, along_the_edge, 0.0, limits), 0.4);
}

// A base that still goes fast is given less than one that goes as it is told.
TEST(KeepIn, CountsTheSpeedItHas) {
  const auto limits = with_reaction(0.2);
  auto pose = at(4.9, 0.0, 0.0);
  const double steady = speed_within_area(0.4, pose, 0.0, limits);
  pose.velocity.forward_mps = steady;
  EXPECT_NEAR(speed_within_area(0.4, pose, 0.0, limits), steady, 1e-12);
  pose.velocity.forward_mps = 2.0 * steady;
  EXPECT_LT(speed_within_area(0.4, pose, 0.0, limits), 0.8 * steady);
  pose.velocity.forward_mps = 0.6;
  EXPECT_EQ(speed_within_area(0.4, pose, 0.0, limits), 0.0);
  pose.velocity.forward_mps = -0.6;
  EXPECT_NEAR(speed_within_area(0.4, pose, 0.0, limits), steady, 1e-12) << "it moves away";
}

TEST(KeepIn, FasterBaseTurnsFartherUntilItStands) {
  const auto limits = with_reaction(0.2);
  auto pose = at(0.0, 4.95, -0.5);  // away from the edge, but not by much
  EXPECT_EQ(speed_within_area(0.2, pose, 0.0, limits), 0.2);
  pose.velocity.forward_mps = 1.0;
  EXPECT_LT(speed_within_area(0.2, pose, 0.0, limits), 0.2);
}

TEST(KeepIn, CanBeSwitchedOff) {
  auto limits = with_reaction(0.2);
  limits.keep_in.enabled = false;
  EXPECT_EQ(speed_within_area(0.4, at(50.0, 0.0, 0.0), 0.0, limits), 0.4);
}

// From wherever it starts, at the speed it is allowed, braking along any arc of its turn rate it comes to rest inside.
TEST(KeepInProperty, BrakingAlongAnyArcEndsInside) {
  std::mt19937_64 random(20261121);
  const auto draw = [&](double from, double to) { return std::uniform_real_distribution(from, to)(random); };
  int slowed = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    auto limits = with_reaction(draw(0.0, 0.3));
    limits.max_deceleration_mps2 = draw(0.3, 2.0);
    auto pose = at(draw(4.0, 5.0), draw(-5.0, -4.0), draw(-10.0, 10.0));
    const double asked = draw(-1.0, 1.0);
    limits.max_turn_radps = draw(0.0, 2.0);
    double v = speed_within_area(asked, pose, 0.0, limits);
    ASSERT_LE(std::abs(v), std::abs(asked));
    ASSERT_GE(v * asked, 0.0) << "never turned round";
    slowed += v != asked ? 1 : 0;

    const double arc_turn = std::clamp(draw(-3.0, 3.0), -1.0, 1.0) * limits.max_turn_radps;
    const double step_s = 1e-3;
    double unbraked_s = limits.reaction_s;
    while (v != 0.0) {
      pose.x_m += v * std::cos(pose.heading_rad) * step_s;
      pose.y_m += v * std::sin(pose.heading_rad) * step_s;
      pose.heading_rad += arc_turn * step_s;
      unbraked_s -= step_s;
      const double loss = unbraked_s > 0.0 ? 0.0 : limits.max_deceleration_mps2 * step_s;
      v = std::copysign(std::max(0.0, std::abs(v) - loss), v);
    }
    const double slack = 2e-3;  // of the integration
    ASSERT_LE(std::abs(pose.x_m), 5.0 + slack) << trial;
    ASSERT_LE(std::abs(pose.y_m), 5.0 + slack) << trial;
  }
  EXPECT_GT(slowed, 200);
}

}  // namespace
}  // namespace cgsr
