#include "pipeline/illumination/lamp.h"

#include <random>

#include "tests/illumination/drawn_board.h"

namespace cgsr::illumination {
namespace {

ProbeShadow exact_shadow(const Board& board, std::size_t probe, const Eigen::Vector3d& p_BL, double sigma_m = 2e-4) {
  ProbeShadow shadow;
  shadow.p_BS = cast(p_BL, board.probe[probe].p_BA);
  shadow.covariance = sigma_m * sigma_m * Eigen::Matrix2d::Identity();
  shadow.lines = 2;
  return shadow;
}

const geometry::Matrix6d kSure = 1e-12 * geometry::Matrix6d::Identity();

TEST(LampProperty, TheRayOfAShadowThroughItsTipMeetsTheLamp) {
  std::mt19937 random(3);
  const Board board = shipped_board();
  for (int trial = 0; trial < 60; ++trial) {
    const Eigen::Vector3d p_BL = lamp_at(5.0 + random() % 60, random() % 360);
    const auto left = exact_shadow(board, 0, p_BL);
    const auto right = exact_shadow(board, 1, p_BL);
    EXPECT_LT((on_ray(left.p_BS, board.probe[0].p_BA, p_BL.z()) - p_BL).norm(), 1e-9);
    for (int which = 1; which <= 3; ++which) {
      const auto lamp =
          estimate_lamp(board, {}, {(which & 1) != 0 ? &left : nullptr, (which & 2) != 0 ? &right : nullptr}, kSure);
      ASSERT_EQ(lamp.status, LampStatus::kFound);
      EXPECT_EQ(lamp.probes, which);
      EXPECT_LT((lamp.p_RL - board.X_RB * p_BL).norm(), 1e-3);
      if (which == 3) {
        ASSERT_TRUE(lamp.triangulated);
        EXPECT_LT((lamp.p_RL_triangulated - board.X_RB * p_BL).norm(), 1e-2);
      }
    }
  }
}

TEST(LampProperty, DerivativesOfAShadowAreThoseOfSmallSteps) {
  const Eigen::Vector3d lamp(0.7, -0.4, 1.8);
  const Eigen::Vector3d tip(0.01, 0.2, 0.1);
  const auto model = shadow_of(lamp, tip);
  EXPECT_LT((model.p_BS - cast(lamp, tip)).norm(), 1e-12);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(k);
    EXPECT_LT(((cast(lamp + step, tip) - cast(lamp - step, tip)) / 2e-6 - model.J_lamp.col(k)).norm(), 1e-6);
    EXPECT_LT(((cast(lamp, tip + step) - cast(lamp, tip - step)) / 2e-6 - model.J_tip.col(k)).norm(), 1e-6);
  }
}

// The covariance says how far the answer is off when tips, camera and shadows err as stated.
TEST(LampProperty, CovarianceIsHonest) {
  std::mt19937 random(11);
  const auto normal = [&random] {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += random() / 4294967296.0;
    return sum;
  };
  const Board board = shipped_board();
  double chi2 = 0.0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector3d p_RL = board.X_RB * lamp_at(35, trial) + Eigen::Vector3d(0, 0, 0.02 * normal());
    Board real = board;
    real.X_RB.linear() = board.X_RB.linear() *
                         geometry::rotation_of(board.turn_sigma_rad * Eigen::Vector3d(normal(), normal(), normal()));
    std::array<ProbeShadow, 2> shadow;
    for (std::size_t i = 0; i < 2; ++i) {
      for (int k = 0; k < 3; ++k) real.probe[i].p_BA[k] += board.place_sigma_m * normal();
      shadow[i] = exact_shadow(real, i, real.X_RB.inverse() * p_RL, 5e-4);
      shadow[i].p_BS += 5e-4 * Eigen::Vector2d(normal(), normal());
    }
    const auto lamp = estimate_lamp(board, {}, {&shadow[0], &shadow[1]}, kSure);
    ASSERT_EQ(lamp.status, LampStatus::kFound);
    const Eigen::Vector3d off = lamp.p_RL - p_RL;
    chi2 += off.dot(lamp.covariance.inverse() * off) / kTrials;
  }
  EXPECT_GT(chi2, 2.5);
  EXPECT_LT(chi2, 3.5);
}

TEST(Lamp, OneLineIsAPlaneAndTwoPlanesAreALamp) {
  const Board board = shipped_board();
  const Eigen::Vector3d p_BL = lamp_at(40, 100);
  std::array<ProbeShadow, 2> line{exact_shadow(board, 0, p_BL), exact_shadow(board, 1, p_BL)};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto outline = outline_of(board.probe[i].foot_B, 0.02, line[i].p_BS);
    const Eigen::Vector2d across = outline.inward[i];  // of the left cone its left line, of the right cone its right
    line[i].lines = 1;
    line[i].covariance =
        0.25 * (Eigen::Matrix2d::Identity() - across * across.transpose()) + 4e-8 * across * across.transpose();
  }
  const auto alone = estimate_lamp(board, {}, {&line[0], nullptr}, kSure);
  EXPECT_EQ(alone.status, LampStatus::kPartial);
  EXPECT_GT(alone.covariance.trace(), 1.0);
  const auto both = estimate_lamp(board, {}, {&line[0], &line[1]}, kSure);
  EXPECT_EQ(both.status, LampStatus::kFound);
  EXPECT_LT((both.p_RL - board.X_RB * p_BL).norm(), 0.01);
  EXPECT_LT(both.covariance.trace(), 0.1);
}

TEST(Lamp, RaysThatPassEachOtherAreDiscarded) {
  const Board board = shipped_board();
  const auto left = exact_shadow(board, 0, lamp_at(30, 0));
  const auto right = exact_shadow(board, 1, lamp_at(30, 0) + Eigen::Vector3d(0.0, 0.6, 0.0));
  EXPECT_EQ(estimate_lamp(board, {}, {&left, &right}, kSure).status, LampStatus::kDisagree);
  const auto nearer = exact_shadow(board, 1, lamp_at(30, 0) + Eigen::Vector3d(0.0, 0.02, 0.0));
  const auto lamp = estimate_lamp(board, {}, {&left, &nearer}, kSure);
  ASSERT_EQ(lamp.status, LampStatus::kFound);
  EXPECT_NEAR((lamp.p_RL - board.X_RB * lamp_at(30, 0)).y(), 0.01, 0.003);  // their mean
}

TEST(LampFault, ALampBelowTheTipsIsNamed) {
  const Board board = shipped_board();
  LampParameters low;
  low.height_m = 0.8;
  const auto checked = check_lamp(board, low);
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message.find("lamp.height_m = 0.8"), std::string::npos);
  const auto left = exact_shadow(board, 0, lamp_at(30, 0));
  EXPECT_EQ(estimate_lamp(board, low, {&left, nullptr}, kSure).status, LampStatus::kBelowTips);
  EXPECT_EQ(estimate_lamp(board, {}, {nullptr, nullptr}, kSure).status, LampStatus::kNoShadow);
}

}  // namespace
}  // namespace cgsr::illumination
