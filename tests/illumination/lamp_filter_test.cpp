#include "pipeline/illumination/lamp_filter.h"

#include <cmath>
#include <random>

#include <Eigen/LU>

#include "tests/illumination/drawn_board.h"

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

ProbeObservation seen_from(const Board& real, const geometry::Pose& X_WR, const std::vector<Vector3d>& lamps_W) {
  ProbeObservation observation;
  observation.status = lamps_W.empty() ? ObservationStatus::kNoShadow : ObservationStatus::kSeen;
  observation.registration.good = true;
  observation.registration.X_BC = real.X_BC;
  for (std::size_t i = 0; i < 2; ++i) {
    for (const Vector3d& p_WL : lamps_W) {
      ProbeShadow shadow;
      shadow.p_BS = cast(real.X_RB.inverse() * (X_WR.inverse() * p_WL), real.probe[i].p_BA);
      shadow.covariance = 4e-8 * Eigen::Matrix2d::Identity();
      shadow.lines = 2;
      observation.probe[i].shadow[static_cast<std::size_t>(observation.probe[i].count++)] = shadow;
    }
  }
  return observation;
}

geometry::Pose around(const Vector3d& lamp, double angle_deg, double heading_deg) {
  const double a = angle_deg * M_PI / 180.0;
  return geometry::pose_on_floor(lamp.x() + 1.2 * std::cos(a), lamp.y() + 1.2 * std::sin(a),
                                 heading_deg * M_PI / 180.0);
}

const geometry::Matrix6d kPose = 1e-6 * geometry::Matrix6d::Identity();

TEST(LampFilter, TurningAroundTellsTheLampFromTheBoardsOwnErrors) {
  const Board board = shipped_board();
  Board real = board;
  real.probe[0].p_BA += Vector3d(0.0008, -0.0006, 0.0004);
  real.probe[1].p_BA += Vector3d(-0.0005, 0.0007, 0.0006);
  const Vector3d lamp(4.0, 3.0, 2.74);
  LampFilter filter(board, {});
  double first_error = 0.0;
  double first_sigma = 0.0;
  for (int i = 0; i < 40; ++i) {
    const auto X_WR = around(lamp, 9.0 * i, 40.0 * i);
    filter.update(seen_from(real, X_WR, {lamp}), X_WR, kPose);
    ASSERT_EQ(filter.count(), 1) << i;
    if (i == 0) {
      first_error = (filter.lamp(0).p_WL - lamp).norm();
      first_sigma = std::sqrt(filter.lamp(0).covariance.trace());
    }
  }
  EXPECT_TRUE(filter.lamp(0).steady);
  EXPECT_LT((filter.lamp(0).p_WL - lamp).norm(), 0.012);
  EXPECT_LT((filter.lamp(0).p_WL - lamp).norm(), first_error);
  EXPECT_LT(std::sqrt(filter.lamp(0).covariance.trace()), 0.6 * first_sigma);
}

TEST(LampFilter, StandingStillDoesNotFeignAccuracy) {
  const Board board = shipped_board();
  const Vector3d lamp(4.0, 3.0, 2.75);
  const auto X_WR = around(lamp, 30.0, 200.0);
  LampFilter filter(board, {});
  filter.update(seen_from(board, X_WR, {lamp}), X_WR, kPose);
  const double first = std::sqrt(filter.lamp(0).covariance.trace());
  for (int i = 0; i < 100; ++i) filter.update(seen_from(board, X_WR, {lamp}), X_WR, kPose);
  EXPECT_GT(std::sqrt(filter.lamp(0).covariance.trace()), 0.6 * first);
}

TEST(LampFilter, StandingStillDoesNotMakeThePoseSurer) {
  const Board board = shipped_board();
  const Vector3d lamp(4.0, 3.0, 2.75);
  const auto X_WR = around(lamp, 30.0, 200.0);
  const geometry::Matrix6d pose = 9e-4 * geometry::Matrix6d::Identity();
  const auto sigma_after = [&](const LampParameters& parameters) {
    LampFilter filter(board, parameters);
    for (int i = 0; i < 100; ++i) filter.update(seen_from(board, X_WR, {lamp}), X_WR, pose);
    return std::sqrt(filter.lamp(0).covariance.topLeftCorner<2, 2>().trace());
  };
  LampParameters anew;
  anew.pose_error_way_m = 0.0;
  EXPECT_GT(sigma_after({}), 0.04) << "3 cm along x and along y";
  EXPECT_LT(sigma_after(anew), 0.5 * sigma_after({})) << "an error of each image by itself is averaged out";
}

// Errors that fade over 1.5 m along a way of 2.4 m: what the filter states has to hold for them, which it would not if it took them for errors of each image.
TEST(LampFilter, StatesHowFarItIsOffWhenErrorsOfThePoseLast) {
  constexpr int kDrives = 60;
  constexpr double kSigma_m = 0.03;
  constexpr double kBound = 9.21;  // two degrees of freedom, 99 %
  Board board = shipped_board();   // measured so well that the pose's error is the largest
  board.place_sigma_m = 1e-4;
  board.turn_sigma_rad = 1e-4;
  const Vector3d lamp(4.0, 3.0, 2.75);
  geometry::Matrix6d pose = geometry::Matrix6d::Zero();
  pose(0, 0) = pose(1, 1) = kSigma_m * kSigma_m;
  LampParameters lasting;
  lasting.height_sigma_m = 0.001;
  LampParameters anew = lasting;
  anew.pose_error_way_m = 0.0;
  std::minstd_rand bits(1);
  const auto normal = [&bits] {  // nearly
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(bits()) / static_cast<double>(std::minstd_rand::max());
    return sum;
  };
  int within = 0;
  int within_if_anew = 0;
  for (int drive = 0; drive < kDrives; ++drive) {
    LampFilter lasting_filter(board, lasting);
    LampFilter anew_filter(board, anew);
    Vector2d off(kSigma_m * normal(), kSigma_m * normal());
    for (int i = 0; i < 40; ++i) {
      const auto X_WR = around(lamp, 2.9 * i, 120.0);
      const double left = std::exp(-0.06 / 1.5);
      const double fresh = kSigma_m * std::sqrt(1.0 - left * left);
      if (i > 0) off = left * off + fresh * Vector2d(normal(), normal());
      geometry::Pose told = X_WR;
      told.translation().head<2>() += off;
      const auto seen = seen_from(board, X_WR, {lamp});
      lasting_filter.update(seen, told, pose);
      anew_filter.update(seen, told, pose);
    }
    const auto is_within = [&](const LampFilter& filter) {
      const Vector2d error = (filter.lamp(0).p_WL - lamp).head<2>();
      const Eigen::Matrix2d P = filter.lamp(0).covariance.topLeftCorner<2, 2>();
      return error.dot(P.inverse() * error) < kBound;
    };
    within += is_within(lasting_filter) ? 1 : 0;
    within_if_anew += is_within(anew_filter) ? 1 : 0;
  }
  EXPECT_GE(within, 57);
  EXPECT_LT(within_if_anew, 50);
}

TEST(LampFilter, TwoLampsAreKeptApartAndOneThatGoesOffIsNoticed) {
  const Board board = shipped_board();
  const Vector3d one(4.0, 3.0, 2.75);
  const Vector3d other(5.5, 3.4, 2.75);
  LampFilter filter(board, {});
  for (int i = 0; i < 8; ++i) {
    const auto X_WR = around(one, 200.0 + 5 * i, 5.0 * i);
    filter.update(seen_from(board, X_WR, {one, other}), X_WR, kPose);
  }
  ASSERT_EQ(filter.count(), 2);
  const double apart = (filter.lamp(0).p_WL - filter.lamp(1).p_WL).norm();
  EXPECT_NEAR(apart, (one - other).norm(), 0.05);
  bool gone = false;
  for (int i = 0; i < 40 && !gone; ++i) {
    const auto X_WR =
        geometry::pose_on_floor(one.x() - 1.0, one.y() + 0.1, M_PI);  // shadows fall towards the camera's free side
    gone = filter.update(seen_from(board, X_WR, {}), X_WR, kPose).gone;
  }
  EXPECT_TRUE(gone);
}

}  // namespace
}  // namespace cgsr::illumination
