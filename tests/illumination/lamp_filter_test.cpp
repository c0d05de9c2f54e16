#include "pipeline/illumination/lamp_filter.h"

#include "tests/illumination/drawn_board.h"

namespace cgsr::illumination {
namespace {

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
