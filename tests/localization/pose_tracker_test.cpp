#include "pipeline/localization/pose_tracker.h"

#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/localization/random_numbers.h"
#include "tests/localization/small_room.h"

namespace cgsr::localization {
namespace {

using geometry::Pose;
using testing::in_small_room;
using testing::Picture;
using testing::small_room;

constexpr double kDegree = std::numbers::pi / 180.0;

class Tracking : public ::testing::Test {
 protected:
  Tracking()
      : map_(small_room()),
        camera_(geometry::Camera{}.scaled_to(320, 240)),
        X_RC_(in_small_room(0.0, 0.0, 0.0)),
        localizer_(map_, camera_, {}),
        tracker_(localizer_, X_RC_, {}) {}

  static constexpr PriorSigmas kKnown{.x_m = 0.02, .y_m = 0.02, .z_m = 0.01, .heading_rad = 0.01, .tilt_rad = 0.005};

  const TrackedPose& see(const Pose& X_WR) {
    const Picture picture(map_, X_WR * X_RC_, camera_, 1.5, ++number_);
    return tracker_.see(picture.view(), budget_);
  }
  const TrackedPose& see_black() { return see_all_of(2); }
  const TrackedPose& see_grey() { return see_all_of(120); }
  const TrackedPose& see_all_of(std::uint8_t level) {
    const std::vector<std::uint8_t> image(320 * 240, level);
    return tracker_.see(
        {.data = image.data(), .width_px = 320, .height_px = 240, .stride_bytes = 320, .format = PixelFormat::kGrey8},
        budget_);
  }

  world::Map map_;
  geometry::Camera camera_;
  Pose X_RC_;
  Localizer localizer_;
  PoseTracker tracker_;
  UnlimitedBudget budget_;
  std::uint32_t number_ = 0;
};

// Odometry that turns and drives 5 % too little: the pose stays with the robot.
TEST_F(Tracking, FollowsARobotThatSlips) {
  Pose X_WR = geometry::pose_on_floor(0.8, 1.5, 0.0);
  tracker_.start(prior_at(X_WR * X_RC_, kKnown));
  for (int i = 0; i < 25; ++i) {
    const TrackedPose& now = see(X_WR);
    EXPECT_EQ(now.state, TrackState::kTracking) << to_string(now.correction.reason);
    const geometry::Vector6d error = geometry::step_between(X_WR * X_RC_, now.X_WC);
    EXPECT_LT(error.head<3>().norm(), 0.02) << i;
    EXPECT_LT(error.tail<3>().norm(), 0.5 * kDegree) << i;
    X_WR = X_WR * geometry::pose_on_floor(0.03, 0.0, 0.02);
    tracker_.moved(geometry::pose_on_floor(0.0285, 0.0, 0.019));
  }
}

TEST_F(Tracking, BlackImagesLeaveThePredictionAndAreSaidToBeALoss) {
  const Pose X_WR = geometry::pose_on_floor(1.0, 1.6, 0.2);
  tracker_.start(prior_at(X_WR * X_RC_, kKnown));
  ASSERT_EQ(see(X_WR).state, TrackState::kTracking);
  for (int i = 1; i < 40; ++i) {
    tracker_.moved(Pose::Identity());
    const Pose predicted = tracker_.now().X_WC;
    const TrackedPose& now = see_black();
    EXPECT_EQ(now.correction.reason, Reason::kTooDark);
    EXPECT_LT(geometry::step_between(predicted, now.X_WC).norm(), 0.02);
    EXPECT_EQ(now.state, i < PoseTrackerParameters{}.max_missed_corrections ? TrackState::kTracking : TrackState::kLost)
        << i;
  }
  // The light comes back: found again, and told once.
  bool recovered = false;
  for (int i = 0; i < 60 && !recovered; ++i) recovered = see(X_WR).state == TrackState::kRecovered;
  EXPECT_TRUE(recovered);
  EXPECT_EQ(see(X_WR).state, TrackState::kTracking);
  EXPECT_LT(geometry::step_between(X_WR * X_RC_, tracker_.now().X_WC).head<3>().norm(), 0.02);
}

// A good image that shows nothing of the map, as before a bare wall, is no failure: the pose is carried until that has made it too uncertain.
TEST_F(Tracking, ABareWallIsNoLossUntilThePoseIsTooUncertain) {
  const Pose X_WR = geometry::pose_on_floor(1.0, 1.6, 0.2);
  tracker_.start(prior_at(X_WR * X_RC_, kKnown));
  ASSERT_EQ(see(X_WR).state, TrackState::kTracking);
  const PoseTrackerParameters parameters;
  Pose X_R0R1 = Pose::Identity();
  X_R0R1.translation().x() = 0.02;
  int images = 0;
  for (TrackState state = TrackState::kTracking; state == TrackState::kTracking && images < 1000; ++images) {
    tracker_.moved(X_R0R1);
    const TrackedPose& now = see_grey();
    ASSERT_EQ(now.correction.reason, Reason::kTooFewEdges);
    state = now.state;
  }
  EXPECT_GT(images, 3 * parameters.max_missed_corrections);
  const geometry::Matrix6d& covariance = tracker_.now().covariance;
  const double place = std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
  EXPECT_TRUE(place > parameters.max_sigma_m || std::sqrt(covariance(5, 5)) > parameters.max_sigma_deg * kDegree);
}

// A camera that images saw lean to one side, as one does whose mount was told wrong, leans on where they show nothing of it, and stays where it is;
// over minutes it comes back to what was told, and is believed no better than that.
TEST_F(Tracking, TheMountsTiltIsKeptAndSlowlyForgottenAndMovesNothingAside) {
  const Pose X_WC = geometry::pose_on_floor(1.0, 1.6, 0.2) * X_RC_;
  geometry::Vector6d lean = geometry::Vector6d::Zero();
  lean.segment<2>(3) << 0.4 * kDegree, -0.3 * kDegree;
  tracker_.start(prior_at(geometry::moved(X_WC, lean), kKnown));
  geometry::Vector6d left = geometry::step_between(X_WC, see_black().X_WC);
  EXPECT_LT(left.head<3>().norm(), 1e-6);
  EXPECT_LT((left - lean).segment<2>(3).norm(), 0.01 * kDegree);
  EXPECT_LT(std::abs(left[5]), 1e-4);
  for (int i = 0; i < 20000; ++i) see_black();
  left = geometry::step_between(X_WC, tracker_.now().X_WC);
  EXPECT_LT(left.head<3>().norm(), 1e-6);
  EXPECT_LT(left.segment<2>(3).norm(), 0.01 * kDegree);
  EXPECT_NEAR(std::sqrt(tracker_.now().covariance(3, 3)), PoseTrackerParameters{}.tilt_deg * kDegree, 0.01 * kDegree);
}

// The camera is carried away unseen by 20 cm and 6 degrees: the belief widens until the pose is found.
TEST_F(Tracking, RecoversFromBeingCarriedAway) {
  Pose X_WR = geometry::pose_on_floor(1.0, 1.6, 0.2);
  tracker_.start(prior_at(X_WR * X_RC_, kKnown));
  ASSERT_EQ(see(X_WR).state, TrackState::kTracking);
  X_WR = geometry::pose_on_floor(1.15, 1.48, 0.2 + 6.0 * kDegree);
  bool recovered = false;
  for (int i = 0; i < 250 && !recovered; ++i) {
    tracker_.moved(Pose::Identity());
    const TrackedPose& now = see(X_WR);
    recovered = now.correction.corrected;
  }
  ASSERT_TRUE(recovered);
  // The first pose that explains the image may be off by an edge's width or two: half a second later it is not.
  for (int i = 0; i < 15; ++i) {
    tracker_.moved(Pose::Identity());
    see(X_WR);
  }
  EXPECT_LT(geometry::step_between(X_WR * X_RC_, tracker_.now().X_WC).head<3>().norm(), 0.03);
}

TEST_F(Tracking, AnErrorOfTheMapIsNoNewsWithEveryImage) {
  const Pose X_WR = geometry::pose_on_floor(1.0, 1.6, 0.2);
  tracker_.start(prior_at(X_WR * X_RC_, kKnown));
  for (int i = 0; i < 100; ++i) {
    tracker_.moved(Pose::Identity());
    ASSERT_TRUE(see(X_WR).correction.corrected);
  }
  const double map_sigma_m = LocalizerParameters{}.map_sigma_m;
  const Correction& last = tracker_.now().correction;
  for (int i = 0; i < 2; ++i) {
    EXPECT_GE(std::sqrt(tracker_.now().covariance(i, i)), map_sigma_m)
        << "never surer of the place in the world than the map is";
    EXPECT_LT(std::sqrt(last.covariance(i, i)), 0.8 * map_sigma_m) << "but of the place in the map";
  }
}

TEST_F(Tracking, TheBeliefGrowsAlongTheWay) {
  tracker_.start(prior_at(X_RC_, {.x_m = 0.001, .y_m = 0.001, .z_m = 0.01, .heading_rad = 0.001, .tilt_rad = 0.005}));
  for (int i = 0; i < 100; ++i) tracker_.moved(geometry::pose_on_floor(0.02, 0.0, 0.0));
  const geometry::Matrix6d P = tracker_.now().covariance;
  EXPECT_NEAR(tracker_.now().X_WC.translation().x(), 2.0, 1e-9);
  EXPECT_NEAR(std::sqrt(P(0, 0)), 0.05 * 2.0, 0.01) << "5 % of the way, whatever the steps";
  EXPECT_GT(P(1, 1), P(0, 0)) << "the direction's error swings the place to the side";
  EXPECT_LT((P - P.transpose()).norm(), 1e-12);
}

}  // namespace
}  // namespace cgsr::localization
