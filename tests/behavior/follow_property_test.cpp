#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "pipeline/behavior/follow.h"
#include "tests/behavior/sightings.h"

namespace cgsr::behavior {
namespace {

struct Chance {
  std::mt19937_64 random;
  explicit Chance(std::uint64_t seed) : random(seed) {}
  double draw(double from, double to) { return std::uniform_real_distribution(from, to)(random); }
  bool once_in(int times) { return std::uniform_int_distribution(1, times)(random) == 1; }
};

// Whatever is seen, limits and ramps hold, it never goes backwards, and it moves forwards only towards something it sees.
TEST(FollowProperty, KeepsItsLimits) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Chance chance(seed);
    FollowParameters parameters;
    DriveLimits limits;
    limits.max_forward_mps = chance.draw(0.1, 1.0);
    limits.max_turn_radps = chance.draw(0.5, 2.0);
    limits.max_acceleration_mps2 = chance.draw(0.1, 1.0);
    limits.max_deceleration_mps2 = chance.draw(0.1, 1.0);
    parameters.max_search_s = 5.0;
    Follow follow(parameters, {}, limits);
    Velocity before;
    bool visible = false;
    Sighting sighting = nothing();
    for (int image = 0; image < 10000; ++image) {
      if (chance.once_in(visible ? 100 : 200)) visible = !visible;
      sighting = visible ? seen(chance.draw(-20.0, 660.0), chance.draw(1.0, 300.0), chance.draw(1.0, 300.0),
                                chance.draw(-20.0, 400.0))
                         : nothing();
      if (chance.once_in(50)) sighting.box.width = std::nan("");
      sighting.age = seconds(chance.draw(0.0, 0.35));
      const Duration elapsed = chance.once_in(20) ? seconds(chance.draw(0.0, 0.2)) : kImagePeriod;
      const double elapsed_s = to_seconds(elapsed);
      const auto [goal, state, reason, bearing, distance, halt] = follow.decide(sighting, elapsed);

      ASSERT_GE(goal.forward_mps, 0.0) << image;
      ASSERT_LE(goal.forward_mps, limits.max_forward_mps);
      ASSERT_LE(std::abs(goal.left_radps), limits.max_turn_radps);
      const double gain = goal.forward_mps - before.forward_mps;
      ASSERT_LE(gain, limits.max_acceleration_mps2 * elapsed_s + 1e-12);
      if (!halt) {
        ASSERT_GE(gain, -limits.max_deceleration_mps2 * elapsed_s - 1e-12);
      }
      ASSERT_LE(std::abs(goal.left_radps - before.left_radps), limits.max_turn_acceleration_radps2 * elapsed_s + 1e-12);
      if (state != FollowState::kFollowing) {
        ASSERT_TRUE(halt);
        ASSERT_EQ(goal.forward_mps, 0.0);
      }
      ASSERT_EQ(state == FollowState::kFollowing, reason == FollowReason::kSeen || reason == FollowReason::kSeenAtEdge);
      ASSERT_LT(std::abs(bearing), 1.6);
      ASSERT_GE(distance, 0.0);
      before = goal;
    }
  }
}

/// Robot and object on the floor; the camera sits at the robot's centre and looks ahead.
struct Floor {
  double x_m = 0.0, y_m = 0.0, heading_rad = 0.0;
  double object_x_m = 0.0, object_y_m = 0.0;

  [[nodiscard]] double distance_m() const { return std::hypot(object_x_m - x_m, object_y_m - y_m); }
  [[nodiscard]] double bearing_rad() const {
    return std::remainder(std::atan2(object_y_m - y_m, object_x_m - x_m) - heading_rad, 2.0 * 3.14159265358979);
  }
  void move(const Velocity& velocity, double elapsed_s) {
    heading_rad += velocity.left_radps * elapsed_s;
    x_m += velocity.forward_mps * std::cos(heading_rad) * elapsed_s;
    y_m += velocity.forward_mps * std::sin(heading_rad) * elapsed_s;
  }
  /// An upright object 0.3 m wide and 0.6 m high, as a pinhole camera sees it.
  [[nodiscard]] Sighting look() const {
    const double depth_m = distance_m() * std::cos(bearing_rad());
    Sighting sighting = nothing();
    const double column = sighting.cx_px - sighting.fx_px * std::tan(bearing_rad());
    if (depth_m < 0.2 || column < 0.0 || column > 640.0) return sighting;
    return seen(column, 0.3 * 601.8 / depth_m, 0.6 * 579.4 / depth_m, 240.0 - 0.3 * 579.4 / depth_m);
  }
};

// Wherever the object stands, even behind the robot after it was seen once, it ends up ahead and at the distance.
TEST(FollowProperty, ComesToItsDistanceFromAnywhere) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Chance chance(seed);
    FollowParameters parameters;
    parameters.learned_distance_m = 2.0;
    Follow follow(parameters, LearnedSize{0.3 * 601.8 / 2.0, 0.6 * 579.4 / 2.0});
    Floor floor;
    floor.object_x_m = 2.0;
    follow.decide(floor.look(), kImagePeriod);

    const double angle = chance.draw(-3.1, 3.1);
    const double far_m = chance.draw(1.5, 5.0);
    floor.object_x_m = far_m * std::cos(angle);
    floor.object_y_m = far_m * std::sin(angle);
    FollowDecision decision;
    for (int image = 0; image < 30 * 60; ++image) {
      decision = follow.decide(floor.look(), kImagePeriod);
      floor.move(decision.goal, to_seconds(kImagePeriod));
      ASSERT_GT(floor.distance_m(), 1.3) << "seed " << seed << ": never run into it";
    }
    EXPECT_EQ(decision.state, FollowState::kFollowing) << "seed " << seed;
    EXPECT_LT(std::abs(floor.bearing_rad()), 0.06) << "seed " << seed;
    EXPECT_NEAR(floor.distance_m(), 1.5, 0.2) << "seed " << seed;
    EXPECT_NEAR(decision.distance_m, floor.distance_m(), 0.1) << "seed " << seed;
  }
}

}  // namespace
}  // namespace cgsr::behavior
