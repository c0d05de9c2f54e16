#include "src/sinks/pose_truth.h"

#include <gtest/gtest.h>

#include "pipeline/stages/odometry_track.h"

namespace cgsr::sinks::testing {
namespace {

using stages::OdometryTrack;
using stages::pose_of;

stages::PoseEstimate corrected_at(const geometry::Pose& X_WC) {
  stages::PoseEstimate where;
  where.has_map = true;
  where.camera.X_WC = X_WC;
  where.camera.state = localization::TrackState::kTracking;
  where.camera.correction.corrected = true;
  return where;
}

TEST(PoseTruth, MeasuresFromTheFirstCorrectionOn) {
  PoseTruth tally;
  hal::ImageTruth truth;
  truth.stamp = MonoTime{seconds(1.0)};
  hal::Odometry odometry;
  stages::PoseEstimate unsure = corrected_at(geometry::pose_on_floor(9.0, 0.0, 0.0));
  unsure.camera.correction.corrected = false;
  tally.add(truth, unsure, odometry);
  EXPECT_EQ(tally.statistics().images, 0U);

  tally.add(truth, corrected_at(geometry::pose_on_floor(0.03, 0.04, 0.0)), odometry);
  EXPECT_NEAR(tally.statistics().worst_m, 0.05, 1e-12);
  truth.robot = {1.0, 0.0, 0.0};
  truth.camera_m = {1.0, 0.0, 0.0};
  odometry.x_m = 0.9;
  tally.add(truth, corrected_at(geometry::pose_on_floor(1.0, 0.0, 0.1)), odometry);
  EXPECT_EQ(tally.statistics().images, 2U);
  EXPECT_NEAR(tally.statistics().worst_m, 0.05, 1e-12);
  EXPECT_NEAR(tally.statistics().mean_m, 0.025, 1e-12);
  EXPECT_NEAR(tally.statistics().worst_rad, 0.1, 1e-9);
  EXPECT_NEAR(tally.statistics().way_m, 1.0, 1e-12);
  EXPECT_NEAR(tally.statistics().odometry_ends_off_m, 0.1, 1e-12);
  odometry.x_m = 1.02;
  tally.add(truth, corrected_at(geometry::pose_on_floor(1.0, 0.0, 0.0)), odometry);
  EXPECT_NEAR(tally.statistics().odometry_ends_off_m, 0.02, 1e-12);
  EXPECT_NEAR(tally.statistics().odometry_worst_m, 0.1, 1e-12);
}

// A robot that searches the whole map says nowhere that it is anywhere.
TEST(PoseTruth, CountsASearchOfTheWholeMapByItself) {
  PoseTruth tally;
  const hal::ImageTruth truth;
  const hal::Odometry odometry;
  ASSERT_TRUE(tally.add(truth, corrected_at(geometry::Pose::Identity()), odometry));
  stages::PoseEstimate lost = corrected_at(geometry::Pose::Identity());
  lost.camera.correction.corrected = false;
  lost.camera.state = localization::TrackState::kLost;
  EXPECT_TRUE(tally.add(truth, lost, odometry));
  stages::PoseEstimate seeks;
  seeks.has_map = true;
  seeks.search = global_localization::Phase::kTurning;
  seeks.camera.X_WC = geometry::pose_on_floor(9.0, 0.0, 0.0);
  EXPECT_FALSE(tally.add(truth, seeks, odometry));
  EXPECT_TRUE(tally.add(truth, lost, odometry));
  EXPECT_EQ(tally.statistics().images, 3U);
  EXPECT_EQ(tally.statistics().searching, 1U);
  EXPECT_EQ(tally.statistics().lost, 1U);
  EXPECT_EQ(tally.statistics().worst_m, 0.0);
}

TEST(PoseTruth, TellsForHowLongItWasLostOrWrongOnEnd) {
  PoseTruth tally;
  const hal::Odometry odometry;
  const auto add = [&](double at_s, const stages::PoseEstimate& pose) {
    hal::ImageTruth truth;
    truth.stamp = MonoTime{seconds(at_s)};
    tally.add(truth, pose, odometry);
  };
  const stages::PoseEstimate right = corrected_at(geometry::pose_on_floor(0.02, 0.0, 0.0));
  const stages::PoseEstimate off = corrected_at(geometry::pose_on_floor(0.06, 0.0, 0.0));
  const stages::PoseEstimate turned = corrected_at(geometry::pose_on_floor(0.0, 0.0, 0.03));
  stages::PoseEstimate lost = off;
  lost.camera.state = localization::TrackState::kLost;
  stages::PoseEstimate seeks = lost;
  seeks.search = global_localization::Phase::kTurning;
  add(1.0, right);
  add(1.1, off);
  add(1.2, right);
  EXPECT_NEAR(tally.statistics().longest_wrong_s, 0.1, 1e-9);
  add(2.0, off);
  add(2.3, turned);
  add(2.4, lost);
  EXPECT_NEAR(tally.statistics().longest_wrong_s, 0.4, 1e-9) << "being lost is no claim";
  add(3.0, seeks);
  add(3.5, right);
  EXPECT_NEAR(tally.statistics().longest_lost_s, 1.1, 1e-9) << "a search is part of it";
  add(4.0, lost);
  add(4.2, right);
  EXPECT_NEAR(tally.statistics().longest_lost_s, 1.1, 1e-9);
  EXPECT_NEAR(tally.statistics().first_s, 1.0, 1e-9);
  EXPECT_EQ(tally.statistics().images, 9U);
  EXPECT_EQ(tally.statistics().accurate, 4U);
}

hal::Odometry report(double time_s, double x_m, double heading_rad) {
  hal::Odometry odometry;
  odometry.stamp = MonoTime{seconds(time_s)};
  odometry.x_m = x_m;
  odometry.heading_rad = heading_rad;
  odometry.velocity = {1.0, 0.5};
  return odometry;
}

TEST(OdometryTrack, SaysWhereTheRobotWasAtTheExposure) {
  OdometryTrack track;
  EXPECT_FALSE(track.at(MonoTime{}));
  for (int i = 0; i < 300; ++i) track.add(report(0.01 * i, 0.01 * i, 0.005 * i));
  const auto between = track.at(MonoTime{seconds(2.555)});
  ASSERT_TRUE(between);
  EXPECT_NEAR(between->x_m, 2.555, 1e-6);
  EXPECT_NEAR(between->heading_rad, 1.2775, 1e-6);
  const auto after = track.at(MonoTime{seconds(3.03)});
  ASSERT_TRUE(after);
  EXPECT_NEAR(after->heading_rad, 1.495 + 0.5 * 0.04, 1e-6);
  EXPECT_FALSE(track.at(MonoTime{seconds(3.2)})) << "too late to be led on";
  EXPECT_FALSE(track.at(MonoTime{seconds(1.0)})) << "before what is kept";
}

// The same round by a base that says 4 % too little of its way and 3 % too much of its turn, and by one that is right.
TEST(OdometryTrack, ScalesWhatTheBaseReports) {
  OdometryTrack right;
  OdometryTrack scaled({.scale_forward = 1.0 / 0.96, .scale_turn = 1.0 / 1.03});
  hal::Odometry truth = report(0.0, 1.0, 0.3);
  hal::Odometry told = truth;
  for (int i = 0; i < 100; ++i) {
    right.add(truth);
    scaled.add(told);
    const auto step = [](hal::Odometry& odometry, double way_m, double turn_rad) {
      const double middle_rad = odometry.heading_rad + 0.5 * turn_rad;
      odometry.x_m += way_m * std::cos(middle_rad);
      odometry.y_m += way_m * std::sin(middle_rad);
      odometry.heading_rad += turn_rad;
      odometry.stamp = odometry.stamp + seconds(0.01);
    };
    step(truth, 0.02, 0.01);
    step(told, 0.96 * 0.02, 1.03 * 0.01);
  }
  const MonoTime at{seconds(0.985)};
  ASSERT_TRUE(right.at(at) && scaled.at(at));
  EXPECT_NEAR(scaled.at(at)->x_m, right.at(at)->x_m, 1e-9);
  EXPECT_NEAR(scaled.at(at)->y_m, right.at(at)->y_m, 1e-9);
  EXPECT_NEAR(scaled.at(at)->heading_rad, right.at(at)->heading_rad, 1e-9);
  EXPECT_NEAR(scaled.at(at)->velocity.forward_mps, 1.0 / 0.96, 1e-12);
}

TEST(OdometryTrack, ALeaningRobotTurnsAboutItsAxle) {
  hal::Odometry odometry;
  odometry.pitch_rad = 0.1;
  const geometry::Pose X_OR = pose_of(odometry, 0.24);
  EXPECT_LT((X_OR * Eigen::Vector3d(0, 0, 0.24) - Eigen::Vector3d(0, 0, 0.24)).norm(), 1e-12);
  EXPECT_GT((X_OR * Eigen::Vector3d(0, 0, 1.24)).x(), 0.09) << "positive leans forward";
}

}  // namespace
}  // namespace cgsr::sinks::testing
