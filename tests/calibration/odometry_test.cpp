#include "pipeline/calibration/odometry.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/calibration/board_pictures.h"

namespace cgsr::calibration {
namespace {

using geometry::Pose;
using ::testing::HasSubstr;

struct Round {
  std::vector<Pose> X_OR;
  std::vector<Pose> X_WR;
};

/// A round of 40 m with bends to both sides; the odometry counts too little or too much, true poses are off by 1 cm and 0.3 degrees.
Round drive(std::mt19937& random, double forward, double turn, double noise, double step_m = 0.05) {
  Round out;
  Pose X_OR = geometry::pose_on_floor(0.0, 0.0, 0.0);
  Pose X_WR = geometry::pose_on_floor(3.0, 1.0, 2.0);
  for (int i = 0; i < 800; ++i) {
    out.X_OR.push_back(X_OR);
    out.X_WR.push_back(X_WR * geometry::pose_on_floor(0.01 * noise * testing::normal(random),
                                                      0.01 * noise * testing::normal(random),
                                                      0.005 * noise * testing::normal(random)));
    const double bend = (i / 100) % 3 == 0 ? -0.9 : 0.7;
    // Half the turn, the way, the other half: what the odometry's own step is, scaled.
    const auto step = [&](double s, double a) {
      return geometry::pose_on_floor(s * std::cos(0.5 * a), s * std::sin(0.5 * a), a);
    };
    X_OR = X_OR * step(step_m, 0.05 * bend);
    X_WR = X_WR * step(forward * step_m, turn * 0.05 * bend);
  }
  return out;
}

TEST(OdometryGolden, TheTrueScalesComeBack) {
  std::mt19937 random(1);
  for (const auto& [forward, turn] : {std::pair{1.03, 0.95}, std::pair{0.97, 1.08}, std::pair{1.0, 1.0}}) {
    const Round round = drive(random, forward, turn, 1.0);
    const auto scales = calibrate_odometry(round.X_OR, round.X_WR);
    ASSERT_TRUE(scales) << scales.error().message;
    EXPECT_NEAR(scales->forward, forward, 0.004);
    EXPECT_NEAR(scales->turn, turn, 0.008);
    EXPECT_LT(std::abs(scales->forward - forward), 4.0 * scales->sigma_forward);
    EXPECT_LT(std::abs(scales->turn - turn), 4.0 * scales->sigma_turn);
    EXPECT_LT(scales->rms_m, 0.04);
    EXPECT_LE(scales->rms_m, scales->rms_before_m + 1e-3);
    EXPECT_NEAR(scales->way_m, 40.0, 0.1);
  }
}

TEST(OdometryGolden, WithoutNoiseExactly) {
  std::mt19937 random(2);
  const Round round = drive(random, 1.02, 0.9, 0.0);
  const auto scales = calibrate_odometry(round.X_OR, round.X_WR);
  ASSERT_TRUE(scales);
  EXPECT_NEAR(scales->forward, 1.02, 1e-6);
  EXPECT_NEAR(scales->turn, 0.9, 1e-6);
  const auto scaled = scaled_odometry(round.X_OR, scales->forward, scales->turn);
  const Pose ours = scaled.front().inverse() * scaled.back();
  const Pose truth = round.X_WR.front().inverse() * round.X_WR.back();
  EXPECT_LT((ours.translation() - truth.translation()).norm(), 1e-4);
}

TEST(OdometryFault, RefusedWithTheReason) {
  std::mt19937 random(3);
  Round round = drive(random, 1.0, 1.0, 1.0);
  const auto few =
      calibrate_odometry({round.X_OR.begin(), round.X_OR.begin() + 20}, {round.X_WR.begin(), round.X_WR.begin() + 20});
  ASSERT_FALSE(few);
  EXPECT_NE(few.error().message.find("expected at least 2 m"), std::string::npos);
  round.X_OR.pop_back();
  EXPECT_FALSE(calibrate_odometry(round.X_OR, round.X_WR));
  EXPECT_FALSE(calibrate_odometry({}, {}));
}

std::string refusal(const Round& round) {
  const auto fit = calibrate_odometry(round.X_OR, round.X_WR);
  return fit ? "" : fit.error().message;
}

// Whatever scales fit best, they say nothing.
TEST(OdometryFault, PosesThatDoNotBelongToTheOdometryAreRefused) {
  std::mt19937 random(4);
  Round round = drive(random, 1.0, 1.0, 1.0);
  std::rotate(round.X_WR.begin(), round.X_WR.begin() + 100, round.X_WR.end());
  EXPECT_THAT(refusal(round), HasSubstr("off the true ones; expected at most 10 cm and 5 degrees"));

  round = drive(random, 1.0, 1.0, 1.0);
  Pose X_RC = Pose::Identity();
  X_RC.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  for (Pose& X : round.X_WR) X = X * X_RC;
  EXPECT_THAT(refusal(round), HasSubstr("lean by up to 90 degrees; expected the robot's"));
}

TEST(OdometryFault, AScaleThatNoRobotsFileTakesIsRefused) {
  std::mt19937 random(5);
  EXPECT_THAT(refusal(drive(random, 0.3048, 1.0, 0.0)), HasSubstr("the scale of forward is 0.3048; expected 0.5..2"));
  EXPECT_THAT(refusal(drive(random, 1.0, 2.2, 0.0)), HasSubstr("the scale of turn is 2.2000; expected 0.5..2"));
  EXPECT_EQ(refusal(drive(random, 0.55, 1.9, 0.0)), "");
}

// Nearly on the spot: the turn shows, what a metre is does not.
TEST(OdometryFault, AScaleThatIsKnownBadlyIsRefused) {
  std::mt19937 random(6);
  EXPECT_THAT(refusal(drive(random, 1.0, 1.0, 3.0, 0.004)), HasSubstr("expected a standard error of at most 0.03"));
  EXPECT_EQ(refusal(drive(random, 1.0, 1.0, 0.1, 0.004)), "");
}

}  // namespace
}  // namespace cgsr::calibration
