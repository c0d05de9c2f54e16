#include "pipeline/calibration/mount.h"

#include <gtest/gtest.h>

#include "tests/calibration/board_pictures.h"

namespace cgsr::calibration {
namespace {

using geometry::Pose;
constexpr double kDegree = 3.14159265358979 / 180.0;
const Board kBoard{9, 6, 0.06};

/// A camera 0.9 m high, 6 cm to the left, looking 25 degrees down and 3 to the left.
Pose true_mount() {
  Eigen::Matrix3d from_camera_axes;
  from_camera_axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // R's axes out of C's, for a level camera
  Pose X_RC = Pose::Identity();
  X_RC.linear() = geometry::rotation_of({0.0, 0.0, 3.0 * kDegree}) * geometry::rotation_of({0.0, 25.0 * kDegree, 0.0}) *
                  geometry::rotation_of({0.7 * kDegree, 0.0, 0.0}) * from_camera_axes;
  X_RC.translation() = Eigen::Vector3d(0.12, 0.06, 0.9);
  return X_RC;
}

double turn_between(const Pose& a, const Pose& b) {
  return geometry::vector_of(a.linear().transpose() * b.linear()).norm() / kDegree;
}

BoardView view_of(std::mt19937& random, const Pose& X_RB, double noise) {
  BoardView view{0, testing::corners_of(true_mount().inverse() * X_RB, kBoard, testing::true_camera())};
  for (cv::Point2f& corner : view.corners) {
    corner.x += static_cast<float>(noise * testing::normal(random));
    corner.y += static_cast<float>(noise * testing::normal(random));
  }
  return view;
}

TEST(MountGolden, ABoardOnTheFloorLooksUp) {
  const Pose X_RB = board_on_floor(1.5, 0.3, -90.0 * kDegree);
  EXPECT_TRUE(
      (X_RB * Eigen::Vector3d(0.1, 0.0, 0.0)).isApprox(Eigen::Vector3d(1.5, 0.2, 0.0), 1e-9));  // rows go to the right
  EXPECT_TRUE((X_RB * Eigen::Vector3d(0.0, 0.1, 0.0))
                  .isApprox(Eigen::Vector3d(1.4, 0.3, 0.0), 1e-9));  // and down towards the robot
  EXPECT_NEAR(X_RB.linear().determinant(), 1.0, 1e-9);
}

TEST(MountGolden, FromABoardOnTheFloor) {
  std::mt19937 random(1);
  std::vector<BoardView> views;
  std::vector<Pose> X_RB;
  for (int i = 0; i < 5; ++i) {
    X_RB.push_back(board_on_floor(1.6 + 0.1 * i, 0.25 - 0.03 * i, (-90.0 + 8.0 * i) * kDegree));
    views.push_back(view_of(random, X_RB.back(), 0.15));
    ASSERT_FALSE(views.back().corners.empty());
  }
  for (const std::size_t count : {std::size_t{1}, std::size_t{5}}) {
    const auto mount = mount_from_boards({views.begin(), views.begin() + static_cast<std::ptrdiff_t>(count)},
                                         {X_RB.begin(), X_RB.begin() + static_cast<std::ptrdiff_t>(count)}, kBoard,
                                         testing::true_camera());
    ASSERT_TRUE(mount) << mount.error().message;
    const Eigen::Vector3d off = mount->X_RC.translation() - true_mount().translation();
    EXPECT_LT(off.norm(), 0.01);
    EXPECT_LT(turn_between(mount->X_RC, true_mount()), 0.3);
    for (Eigen::Index i = 0; i < 3; ++i) EXPECT_LT(std::abs(off[i]), 4.0 * mount->sigma_m[i]);
    EXPECT_NEAR(mount->rms, 0.15 * std::sqrt(2.0), 0.06);
    EXPECT_EQ(mount->view_rms.size(), count);
  }
}

TEST(MountFault, BoardsAreRefusedWithTheReason) {
  std::mt19937 random(2);
  const geometry::Camera camera = testing::true_camera();
  const Pose here = board_on_floor(1.6, 0.25, -90.0 * kDegree);
  const Pose there = board_on_floor(1.9, 0.15, -90.0 * kDegree);
  const BoardView one = view_of(random, here, 0.1);
  BoardView other = view_of(random, there, 0.1);
  other.image = 17;
  const auto reason = [&](const std::vector<BoardView>& views, const std::vector<Pose>& X_RB, const Board& board) {
    const auto mount = mount_from_boards(views, X_RB, board, camera);
    return mount ? std::string() : mount.error().message;
  };
  EXPECT_NE(reason({}, {}, kBoard).find("0 views"), std::string::npos);
  EXPECT_NE(reason({one}, {here}, {8, 6, 0.06}).find("turned by half a round"), std::string::npos);
  EXPECT_NE(reason({one, other}, {here, here}, kBoard).find("contradict"), std::string::npos);
  EXPECT_EQ(reason({one, other}, {here, there}, kBoard), "");
}

struct Drive {
  std::vector<Pose> X_WC;
  std::vector<Pose> X_OR;
};

/// A round with corrected camera poses off by 1 cm and 0.2 degrees. \param bend  radians per metre.
Drive drive(std::mt19937& random, double bend, int poses, bool one_circle = false) {
  Drive out;
  const Pose X_WO = geometry::pose_on_floor(2.3, -1.1, 1.1);
  Pose X_OR = Pose::Identity();
  for (int i = 0; i < poses; ++i) {
    out.X_OR.push_back(X_OR);
    geometry::Vector6d error;
    for (Eigen::Index k = 0; k < 6; ++k) error[k] = testing::normal(random) * (k < 3 ? 0.01 : 0.2 * kDegree);
    out.X_WC.push_back(geometry::moved(X_WO * X_OR * true_mount(), error));
    X_OR = X_OR * geometry::pose_on_floor(0.1, 0.0, 0.1 * (one_circle || i % 40 < 25 ? bend : -0.7 * bend));
  }
  return out;
}

TEST(MountGolden, FromPosesBesideOdometry) {
  std::mt19937 random(3);
  for (const double bend : {0.8, -2.0}) {
    const Drive round = drive(random, bend, 80);
    const auto mount = mount_from_poses(round.X_WC, round.X_OR);
    ASSERT_TRUE(mount) << mount.error().message;
    const Eigen::Vector3d off = mount->X_RC.translation() - true_mount().translation();
    EXPECT_LT(off.norm(), 0.012);
    EXPECT_LT(turn_between(mount->X_RC, true_mount()), 0.3);
    for (Eigen::Index i = 0; i < 3; ++i) EXPECT_LT(std::abs(off[i]), 4.0 * mount->sigma_m[i]);
    EXPECT_NEAR(mount->rms, 0.01 * std::sqrt(3.0), 0.005);
  }
}

TEST(MountFault, PosesAreRefusedWithTheReason) {
  std::mt19937 random(4);
  const Drive straight = drive(random, 0.0, 60);
  const auto unknown = mount_from_poses(straight.X_WC, straight.X_OR);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("turned by 0 degrees"), std::string::npos);
  const Drive circle = drive(random, 1.0, 60, true);
  const auto open = mount_from_poses(circle.X_WC, circle.X_OR);
  ASSERT_FALSE(open);
  EXPECT_NE(open.error().message.find("one circle"), std::string::npos);
  Drive round = drive(random, 1.0, 60);
  EXPECT_FALSE(mount_from_poses({round.X_WC[0]}, {round.X_OR[0]}));
  for (std::size_t i = 0; i < round.X_WC.size(); ++i)
    round.X_WC[i].translation() += 0.3 * static_cast<double>(i % 5) * Eigen::Vector3d::UnitX();
  const auto contradicts = mount_from_poses(round.X_WC, round.X_OR);
  ASSERT_FALSE(contradicts);
  EXPECT_NE(contradicts.error().message.find("off the odometry"), std::string::npos);
}

TEST(MountGolden, WhatRobotFilesHold) {
  Mount mount;
  mount.X_RC.translation() = Eigen::Vector3d(0.1, -0.2, 0.9);
  const std::string text = mount_as_toml(mount);
  EXPECT_NE(
      text.find(
          "[mount]\nposition_m = [ 0.100000, -0.200000, 0.900000 ]\nquaternion_wxyz = [ 1.000000000, 0.000000000"),
      std::string::npos)
      << text;
}

}  // namespace
}  // namespace cgsr::calibration
