#include "pipeline/geometry/pose.h"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace cgsr::geometry {
namespace {

double drawn(std::mt19937& random) {
  return static_cast<double>(random()) / 2147483648.0 - 1.0;
}

TEST(PoseProperty, AStepLeadsWhereItWasMeasured) {
  std::mt19937 random(3);
  for (int i = 0; i < 500; ++i) {
    Vector6d first;
    Vector6d second;
    for (int k = 0; k < 6; ++k) {
      first(k) = drawn(random);
      second(k) = drawn(random);
    }
    const Pose from = moved(Pose::Identity(), first);
    const Pose to = moved(from, second);
    EXPECT_LT((step_between(from, to) - second).norm(), 1e-9);
    EXPECT_LT((moved(from, step_between(from, to)).matrix() - to.matrix()).norm(), 1e-9);
  }
}

TEST(Pose, AStepTurnsAboutTheCamerasPlaceNotTheWorlds) {
  const Pose X_WC = pose_on_floor(3.0, 1.0, 0.2);
  Vector6d step = Vector6d::Zero();
  step(5) = 0.3;
  const Pose turned = moved(X_WC, step);
  EXPECT_LT((turned.translation() - X_WC.translation()).norm(), 1e-12);
  EXPECT_NEAR(heading_of(turned), 0.5, 1e-12);
}

TEST(Pose, HeadingIsPositiveToTheLeft) {
  EXPECT_NEAR(heading_of(pose_on_floor(0, 0, std::numbers::pi / 2)), std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR((pose_on_floor(1, 2, std::numbers::pi / 2) * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 0)).norm(),
              0, 1e-12);
}

TEST(Pose, PitchIsPositiveNoseDownWhateverTheHeading) {
  Pose lean = Pose::Identity();
  lean.linear() = rotation_of({0.0, 0.05, 0.0});
  for (const double heading : {0.0, 1.0, -2.5}) {
    EXPECT_NEAR(pitch_of(pose_on_floor(1.0, 2.0, heading) * lean), 0.05, 1e-12);
    EXPECT_NEAR(pitch_of(pose_on_floor(1.0, 2.0, heading)), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace cgsr::geometry
