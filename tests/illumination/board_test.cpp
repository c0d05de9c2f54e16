#include "pipeline/illumination/board.h"

#include <random>

#include "tests/illumination/drawn_board.h"

namespace cgsr::illumination {
namespace {

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * (random() / 4294967296.0);
}

TEST(BoardProperty, DerivativesOfThePixelAreThoseOfSmallSteps) {
  std::mt19937 random(5);
  const Board board = shipped_board();
  const BoardView view(board.camera, board.X_BC);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector3d p_B(uniform(random, -0.1, 0.15), uniform(random, -0.3, 0.3), uniform(random, 0.0, 0.1));
    const auto d = view.derivative(p_B);
    ASSERT_TRUE(d.in_front);
    EXPECT_LT((d.at - *board.camera.pixel_of(board.X_BC.inverse() * p_B)).norm(), 1e-9);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(k);
      const Eigen::Vector2d change = (view.pixel(p_B + step).at - view.pixel(p_B - step).at) / 2e-6;
      EXPECT_LT((change - d.J_point.col(k)).norm(), 1e-3);
    }
    const auto J_pose = view.pose_jacobian(d, p_B);
    for (int k = 0; k < 6; ++k) {
      const geometry::Vector6d step = 1e-6 * geometry::Vector6d::Unit(k);
      const BoardView plus(board.camera, geometry::moved(board.X_BC, step));
      const BoardView minus(board.camera, geometry::moved(board.X_BC, -step));
      const Eigen::Vector2d change = (plus.pixel(p_B).at - minus.pixel(p_B).at) / 2e-6;
      EXPECT_LT((change - J_pose.col(k)).norm(), 2e-3) << k;
    }
  }
}

TEST(BoardProperty, TheOutlineTouchesTheBaseAndMeetsAtTheTipsShadow) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Vector2d foot(uniform(random, -1, 1), uniform(random, -1, 1));
    const double radius = uniform(random, 0.01, 0.1);
    const double around = uniform(random, -3, 3);
    const Eigen::Vector2d tip =
        foot + radius * uniform(random, 1.1, 9.0) * Eigen::Vector2d(std::cos(around), std::sin(around));
    const Outline outline = outline_of(foot, radius, tip);
    ASSERT_TRUE(outline.valid);
    for (std::size_t side = 0; side < 2; ++side) {
      EXPECT_NEAR((outline.touch[side] - foot).norm(), radius, 1e-12);
      EXPECT_NEAR((tip - outline.touch[side]).dot(outline.inward[side]), 0.0, 1e-12);
      EXPECT_NEAR((foot - outline.touch[side]).dot(outline.inward[side]), radius, 1e-12);
    }
    EXPECT_TRUE(within(outline, foot, radius, foot + 0.8 * (tip - foot), 0.0));
    EXPECT_FALSE(within(outline, foot, radius, foot + 1.1 * (tip - foot), 0.0));
    EXPECT_FALSE(within(outline, foot, radius, foot - 1.1 * (tip - foot).normalized() * radius, 0.0));
  }
  EXPECT_FALSE(outline_of({0, 0}, 0.02, {0.01, 0.0}).valid);
}

TEST(BoardFault, WhatCannotBeIsNamed) {
  const BoardParameters good = shipped_probes().board;
  const auto message = [](const BoardParameters& board, const geometry::Pose& mount, const geometry::Camera& camera) {
    const auto made = make_board(board, mount, camera);
    return made ? std::string() : made.error().message;
  };
  EXPECT_EQ(message(good, shipped_mount(), shipped_camera()), "");
  BoardParameters none = good;
  none.probes = 0;
  EXPECT_NE(message(none, shipped_mount(), shipped_camera()).find("no probes"), std::string::npos);
  BoardParameters low = good;
  low.right.apex_m[2] = 0.9;
  EXPECT_NE(message(low, shipped_mount(), shipped_camera()).find("right.apex_m"), std::string::npos);
  BoardParameters beside = good;
  beside.left.foot_m[1] = 0.5;
  EXPECT_NE(message(beside, shipped_mount(), shipped_camera()).find("left.foot_m"), std::string::npos);
  geometry::Camera other = shipped_camera();  // of another robot: a longer lens
  other.fx_px = other.fy_px = 1100.0;
  EXPECT_NE(message(good, shipped_mount(), other).find("not in the camera's view"), std::string::npos);
  geometry::Pose under = shipped_mount();
  under.translation().z() = 0.95;
  EXPECT_NE(message(good, under, shipped_camera()).find("does not look down"), std::string::npos);
}

}  // namespace
}  // namespace cgsr::illumination
