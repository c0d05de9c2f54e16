#include "pipeline/shade/ball_in_shade.h"

#include <random>

#include <gtest/gtest.h>

#include "pipeline/shade/shadow_volumes.h"
#include "tests/shade/table_map.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::shade {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using geometry::Camera;
using geometry::Pose;
using render::looking_from;
using world::Map;

constexpr double kRadius_m = 0.1;
const Vector3d kLamp(0.0, 0.0, 2.5);  // above the table, whose shade on the floor is 1.71 x 1.14 m

/// What a ball there shows: the mean of the axes of its ellipse.
BallInImage shown(const Vector3d& p_WB, const Pose& X_WC, const Camera& camera) {
  const Vector3d p_C = X_WC.inverse() * p_WB;
  const double angle = std::asin(kRadius_m / p_C.norm());
  const double off_axis = std::acos(p_C.z() / p_C.norm());
  const double along = 0.5 * (std::tan(off_axis + angle) - std::tan(off_axis - angle));
  const double across = std::tan(angle) / std::cos(off_axis);
  return {camera.pixel_of(p_C).value(), 0.5 * (camera.fx_px + camera.fy_px) * 0.5 * (along + across), kRadius_m};
}

class BallInShade : public testing::Test {
 protected:
  [[nodiscard]] bool may_be_shaded(const Vector3d& p_WB, const ShadeErrors& errors = {}) {
    volumes_.look(X_WC_, Camera(), kLamp, errors);
    return volumes_.may_be_shaded(shown(p_WB, X_WC_, Camera()));
  }
  [[nodiscard]] bool is_shaded(const Vector3d& p_WB, const ShadeErrors& errors = {}) {
    volumes_.look(X_WC_, Camera(), kLamp, errors);
    return volumes_.is_shaded(shown(p_WB, X_WC_, Camera()));
  }

  Map map_ = table_over_floor();
  ShadowVolumes volumes_{map_, {}};
  Pose X_WC_ = looking_from({-3.0, 0.0, 1.2}, {0.0, 0.0, 0.3});
};

TEST_F(BallInShade, OnTheFloorUnderTheTableItIsBesideAndAboveItIsNot) {
  EXPECT_TRUE(may_be_shaded({0.0, 0.0, kRadius_m}));
  EXPECT_TRUE(may_be_shaded({0.6, 0.3, 0.3})) << "in the volume, off the floor";
  EXPECT_TRUE(may_be_shaded({0.0, 0.6, kRadius_m})) << "half of it";
  EXPECT_FALSE(may_be_shaded({0.0, 0.95, kRadius_m})) << "the floor that it lies on throws no shade on it";
  EXPECT_FALSE(may_be_shaded({0.0, 0.0, 0.75 + kRadius_m})) << "nor does the table";
}

TEST_F(BallInShade, DeepUnderTheTableItSurelyIsAtTheBorderItIsNot) {
  EXPECT_TRUE(is_shaded({0.0, 0.0, kRadius_m}));
  EXPECT_FALSE(is_shaded({0.0, 0.6, kRadius_m})) << "half of it";
  EXPECT_FALSE(is_shaded({0.0, 0.95, kRadius_m})) << "beside";
  ShadeErrors errors;
  errors.lamp = 0.4 * 0.4 * Eigen::Matrix3d::Identity();
  EXPECT_FALSE(is_shaded({0.0, 0.0, kRadius_m}, errors)) << "the lamp may be elsewhere";
}

// The ray to either passes through the shade under the table: a mask of rays says the same of both.
TEST_F(BallInShade, BeforeAndBehindTheShadeOnOneRayItIsNot) {
  X_WC_ = looking_from({-3.0, 0.0, 0.7}, {0.0, 0.0, 0.3});
  const Vector3d before(-1.5, 0.0, 0.5);
  const Vector3d behind(1.5, 0.0, 0.1);
  EXPECT_TRUE(may_be_shaded({0.0, 0.0, 0.3}));
  EXPECT_FALSE(may_be_shaded(before));
  EXPECT_FALSE(may_be_shaded(behind));
  const ShadeMasks& masks = volumes_.look(X_WC_, Camera(), kLamp, ShadeErrors());
  for (const Vector3d& p_W : {before, behind}) {
    const Eigen::Vector2d pixel = Camera().pixel_of(X_WC_.inverse() * p_W).value();
    const auto cell = static_cast<int>(pixel.y() / 4.0) * masks.width + static_cast<int>(pixel.x() / 4.0);
    EXPECT_NE(masks.possibly_shaded[static_cast<std::size_t>(cell)], 0) << "this test could not fail";
  }
}

TEST_F(BallInShade, ARobotInShadeItselfStillSeesWhatLiesInTheLight) {
  X_WC_ = looking_from({0.0, 0.0, 0.4}, {3.0, 0.0, 0.2});
  EXPECT_FALSE(may_be_shaded({2.5, 0.0, kRadius_m}));
  EXPECT_TRUE(may_be_shaded({0.65, 0.0, 0.3}));
}

TEST_F(BallInShade, WhatLampAndPoseDoNotKnowWidensTheShade) {
  const Vector3d beside(0.0, 0.95, kRadius_m);
  ShadeErrors errors;
  EXPECT_FALSE(may_be_shaded(beside, errors));
  errors.lamp = 0.15 * 0.15 * Eigen::Matrix3d::Identity();
  EXPECT_TRUE(may_be_shaded(beside, errors));
  errors = {};
  errors.pose.bottomRightCorner<3, 3>() = 0.05 * 0.05 * Eigen::Matrix3d::Identity();
  EXPECT_TRUE(may_be_shaded(beside, errors));
}

// Nothing that is shaded by rays of our own is denied, wherever the ball is in the image; and of what is far from every shade nothing is claimed.
TEST_F(BallInShade, RaysToPointsOnBallsAgree) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-1.5, 1.5), across(-1.5, 1.5), height(kRadius_m, 0.55);
  int shaded = 0;
  int lit = 0;
  for (int i = 0; i < 400; ++i) {
    const Vector3d p(along(random), across(random), height(random));
    if (!Camera().pixel_of(X_WC_.inverse() * p)) continue;
    // The shade at this height: the table's rectangle, stretched from the lamp's foot.
    const double stretch = (kLamp.z() - p.z()) / (kLamp.z() - 0.75);
    const double inside = std::min(0.6 * stretch - std::abs(p.x()), 0.4 * stretch - std::abs(p.y()));
    if (inside < kRadius_m) {
      EXPECT_FALSE(is_shaded(p)) << p.transpose();
    }
    if (inside > 0.0) {
      ++shaded;
      EXPECT_TRUE(may_be_shaded(p)) << p.transpose();
    } else if (inside < -0.5) {
      ++lit;
      EXPECT_FALSE(may_be_shaded(p)) << p.transpose();
    }
  }
  EXPECT_GT(shaded, 50);
  EXPECT_GT(lit, 50);
}

// What stands as close to the ball as that throws shade on it where it is, if not on every place where it may be.
TEST(BallInShadeUnderAShelf, ALowShelfThrowsShadeToo) {
  const Map map = table_over_floor(0.25F, 0.01F);
  ShadowVolumes volumes(map, {});
  for (const double distance_m : {1.2, 1.9, 2.5, 4.0}) {
    const Pose X_WC = looking_from({-distance_m, 0.0, 0.2}, {0.0, 0.0, 0.1});
    volumes.look(X_WC, Camera(), kLamp, ShadeErrors());
    EXPECT_TRUE(volumes.may_be_shaded(shown({0.0, 0.0, kRadius_m}, X_WC, Camera()))) << distance_m;
    EXPECT_FALSE(volumes.may_be_shaded(shown({0.0, 0.9, kRadius_m}, X_WC, Camera()))) << distance_m;
  }
}

TEST(BallInShadeFault, WhatIsNotKnownMayBeShaded) {
  const Map map = table_over_floor();
  ShadowVolumes volumes(map, {});
  EXPECT_TRUE(volumes.may_be_shaded({{320.0, 240.0}, 20.0, kRadius_m})) << "nothing was looked at";
  EXPECT_FALSE(volumes.is_shaded({{320.0, 240.0}, 20.0, kRadius_m})) << "nothing was looked at";
  volumes.look(looking_from({-3.0, 0.0, 1.2}, {0.0, 0.0, 0.3}), Camera(), kLamp);
  EXPECT_TRUE(volumes.may_be_shaded({{320.0, 240.0}, 0.0, kRadius_m})) << "no circle";
}

TEST(BallInShadeAlloc, AskingTakesNoMemory) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "SKIPPED: a sanitizer brings its own malloc";
  const Map map = table_over_floor();
  ShadowVolumes volumes(map, {});
  volumes.look(looking_from({-3.0, 0.0, 1.2}, {0.0, 0.0, 0.3}), Camera(), kLamp);
  const test::AllocationGuard guard;
  EXPECT_TRUE(volumes.may_be_shaded({{319.5, 239.5}, 20.0, kRadius_m}));
  EXPECT_FALSE(volumes.is_shaded({{319.5, 39.5}, 20.0, kRadius_m}));
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::shade
