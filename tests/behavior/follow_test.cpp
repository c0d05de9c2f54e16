#include "pipeline/behavior/follow.h"

#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include <gtest/gtest.h>

#include "tests/behavior/sightings.h"

namespace cgsr::behavior {
namespace {

constexpr double kCentre_px = 319.5;

FollowParameters stated_size() {
  FollowParameters parameters;
  parameters.learned_distance_m = 2.0;
  return parameters;
}
constexpr LearnedSize kAtTwoMetres{60.0, 120.0};

TEST(Follow, StandsUntilItHasSeenSomething) {
  Follow follow({}, {});
  const auto decision = repeat(follow, nothing(), 3000);
  EXPECT_EQ(decision.state, FollowState::kWaiting);
  EXPECT_EQ(decision.goal.forward_mps, 0.0);
  EXPECT_EQ(decision.goal.left_radps, 0.0) << "it does not search for what it never saw";
}

TEST(Follow, TurnsTowardsTheObject) {
  Follow follow({}, {});
  const auto right = repeat(follow, seen(kCentre_px + 200.0), 60);
  EXPECT_EQ(right.state, FollowState::kFollowing);
  EXPECT_NEAR(right.bearing_rad, -std::atan(200.0 / 601.8), 1e-12) << "right is negative";
  const FollowParameters parameters;
  EXPECT_NEAR(right.goal.left_radps, parameters.turn_per_s * (right.bearing_rad + parameters.bearing_band_rad), 1e-12);

  const auto left = repeat(follow, seen(kCentre_px - 200.0), 120);
  EXPECT_NEAR(left.goal.left_radps, -right.goal.left_radps, 1e-12);
}

TEST(Follow, LeavesASmallBearingAlone) {
  Follow follow({}, {});
  EXPECT_EQ(repeat(follow, seen(kCentre_px + 15.0), 60).goal.left_radps, 0.0);
}

TEST(Follow, EstimatesTheDistanceFromTheLearnedSize) {
  Follow follow(stated_size(), kAtTwoMetres);
  EXPECT_NEAR(repeat(follow, seen(kCentre_px, 60.0, 120.0), 1).distance_m, 2.0, 1e-12);
  EXPECT_NEAR(repeat(follow, seen(kCentre_px, 30.0, 60.0), 1).distance_m, 4.0, 1e-12);
  EXPECT_NEAR(repeat(follow, seen(kCentre_px, 120.0, 240.0), 1).distance_m, 1.0, 1e-12);
  EXPECT_NEAR(repeat(follow, seen(kCentre_px, 240.0, 120.0), 1).distance_m, 1.0, 1e-12) << "only the area counts";
}

TEST(Follow, TakesTheFirstBoxForTheDistanceWhereNoneIsStated) {
  Follow follow({}, kAtTwoMetres);  // a size, but not where it was measured
  EXPECT_NEAR(repeat(follow, seen(kCentre_px, 50.0, 100.0), 1).distance_m, 1.5, 1e-12);
  EXPECT_NEAR(repeat(follow, seen(kCentre_px, 25.0, 50.0), 1).distance_m, 3.0, 1e-12);
}

TEST(Follow, ApproachesWhatIsFarAndStopsAtTheDistance) {
  Follow follow(stated_size(), kAtTwoMetres);
  const auto far = repeat(follow, seen(kCentre_px, 30.0, 60.0), 120);
  EXPECT_EQ(far.goal.forward_mps, 0.3) << "at its limit";
  const auto nearer = repeat(follow, seen(kCentre_px, 60.0, 120.0), 120);
  EXPECT_NEAR(nearer.goal.forward_mps, 0.5 * (2.0 - 1.5 - 0.15), 1e-12);
  const auto there = repeat(follow, seen(kCentre_px, 80.0, 160.0), 120);
  EXPECT_EQ(there.goal.forward_mps, 0.0);
}

TEST(Follow, NeverBacksAwayUnlessToldSo) {
  Follow blind(stated_size(), kAtTwoMetres);
  EXPECT_EQ(repeat(blind, seen(kCentre_px, 200.0, 300.0, 90.0), 120).goal.forward_mps, 0.0);

  DriveLimits limits;
  limits.max_backward_mps = 0.1;
  Follow brave(stated_size(), kAtTwoMetres, limits);
  EXPECT_EQ(repeat(brave, seen(kCentre_px, 200.0, 300.0, 90.0), 120).goal.forward_mps, -0.1);
}

TEST(Follow, TurnsFirstAndThenDrives) {
  Follow follow(stated_size(), kAtTwoMetres);
  const auto oblique = repeat(follow, seen(kCentre_px + 290.0, 30.0, 60.0), 120);
  EXPECT_NEAR(oblique.goal.forward_mps, 0.5 * (4.0 - 1.5 - 0.15) * (1.0 - std::atan(290.0 / 601.8) / 0.5), 1e-12);

  auto parameters = stated_size();
  parameters.max_driving_bearing_rad = 0.3;
  Follow strict(parameters, kAtTwoMetres);
  const auto aside = repeat(strict, seen(kCentre_px + 290.0, 30.0, 60.0), 120);
  EXPECT_EQ(aside.goal.forward_mps, 0.0);
  EXPECT_LT(aside.goal.left_radps, 0.0);
}

// A box that the image cuts off is smaller than the object: taken for the distance it would drive the robot into it.
TEST(Follow, IsNotFooledByABoxThatTheImageCuts) {
  Follow follow(stated_size(), kAtTwoMetres);
  const auto at_side = follow.decide(seen(10.0, 20.0, 240.0, 100.0), kImagePeriod);
  EXPECT_NEAR(at_side.distance_m, 1.0, 1e-12) << "by its height";
  const auto at_other_side = follow.decide(seen(630.0, 20.0, 240.0, 100.0), kImagePeriod);
  EXPECT_NEAR(at_other_side.distance_m, 1.0, 1e-12);
  const auto at_bottom = follow.decide(seen(kCentre_px, 120.0, 60.0, 420.0), kImagePeriod);
  EXPECT_NEAR(at_bottom.distance_m, 1.0, 1e-12) << "by its width";

  DriveLimits limits;
  limits.max_backward_mps = 0.1;
  Follow other(stated_size(), kAtTwoMetres, limits);
  const auto at_corner = repeat(other, seen(10.0, 20.0, 30.0, 0.0), 60);
  EXPECT_EQ(at_corner.state, FollowState::kFollowing);
  EXPECT_EQ(at_corner.reason, FollowReason::kSeenAtEdge);
  EXPECT_EQ(at_corner.distance_m, 0.0);
  EXPECT_EQ(at_corner.goal.forward_mps, 0.0);
  EXPECT_GT(at_corner.goal.left_radps, 0.0) << "it still turns";
}

TEST(Follow, DoesNotTakeACutBoxForTheReference) {
  Follow follow({}, {});
  EXPECT_EQ(follow.decide(seen(10.0, 20.0, 100.0), kImagePeriod).distance_m, 0.0);
  EXPECT_NEAR(follow.decide(seen(kCentre_px, 50.0, 100.0), kImagePeriod).distance_m, 1.5, 1e-12);
}

TEST(Follow, LostItStandsThenSearchesThenGivesUp) {
  Follow follow(stated_size(), kAtTwoMetres);
  repeat(follow, seen(kCentre_px + 100.0, 30.0, 60.0), 120);

  const auto halted = follow.decide(nothing(), kImagePeriod);
  EXPECT_EQ(halted.state, FollowState::kStanding);
  EXPECT_TRUE(halted.halt);
  EXPECT_EQ(halted.goal.forward_mps, 0.0) << "at once: nobody knows what it would drive towards";
  const auto standing = repeat(follow, nothing(), 28);  // 0.97 s
  EXPECT_EQ(standing.state, FollowState::kStanding);
  EXPECT_EQ(standing.reason, FollowReason::kNotFound);
  EXPECT_EQ(standing.goal.forward_mps, 0.0);
  EXPECT_EQ(standing.goal.left_radps, 0.0);

  EXPECT_EQ(repeat(follow, nothing(), 3).state, FollowState::kSearching);
  const auto searching = repeat(follow, nothing(), 27);
  EXPECT_EQ(searching.state, FollowState::kSearching);
  EXPECT_EQ(searching.goal.forward_mps, 0.0);
  EXPECT_EQ(searching.goal.left_radps, -0.4) << "to the right, where it went";
  EXPECT_EQ(repeat(follow, nothing(), 560).state, FollowState::kSearching);  // 20.6 s

  const auto lost = repeat(follow, nothing(), 60);
  EXPECT_EQ(lost.state, FollowState::kLost);
  EXPECT_EQ(lost.goal.forward_mps, 0.0);
  EXPECT_EQ(lost.goal.left_radps, 0.0);
  EXPECT_EQ(repeat(follow, nothing(), 3000).state, FollowState::kLost);
}

TEST(Follow, SearchesOnTheSideWhereItWasWhenItStoodStill) {
  FollowParameters still;
  still.turn_per_s = 0.0;
  Follow follow(still, {});
  repeat(follow, seen(kCentre_px - 100.0), 60);
  EXPECT_EQ(repeat(follow, nothing(), 90).goal.left_radps, 0.4);
}

TEST(Follow, SearchesOnTheSideOfTheOnlySightingThereWas) {
  Follow follow({}, {});
  repeat(follow, seen(kCentre_px - 100.0), 1);
  EXPECT_EQ(repeat(follow, nothing(), 90).goal.left_radps, 0.4) << "nothing better is known";
}

/// Seen on the left, going to the right at 40 px per second.
void follow_to_the_right(Follow& follow) {
  for (int image = 0; image < 90; ++image) follow.decide(seen(kCentre_px - 200.0 + 1.33 * image), kImagePeriod);
}

TEST(Follow, SearchesInTheDirectionOfMotion) {
  FollowParameters still;
  still.turn_per_s = 0.0;
  still.min_motion_radps = 0.05;
  Follow follow(still, {});
  follow_to_the_right(follow);
  EXPECT_EQ(repeat(follow, nothing(), 90).goal.left_radps, -0.4) << "though it was on the left";
}

// A robot that turns with the object sees it always at the same bearing.
TEST(ConfirmedMotion, TheTurnOfTheRobotCountsAsMotionOfTheObject) {
  ConfirmedMotion motion(0.5);
  for (int image = 0; image < 90; ++image) {
    motion.turned(-0.4, 1.0 / 30.0);
    motion.seen(0.05);
  }
  EXPECT_NEAR(motion.rate_radps(), -0.4, 0.01);
  EXPECT_EQ(motion.bearing_rad(), 0.05);
}

// A twin on the other side that is taken for the object for six images, before the loss or after it, leaves the direction as it was.
TEST(Follow, ATwinThatSwapsSidesDoesNotTurnTheSearch) {
  for (const int images_lost : {0, 1, 12, 45, 90}) {
    Follow follow({}, {});
    repeat(follow, seen(kCentre_px + 100.0), 120);
    repeat(follow, nothing(), images_lost);
    EXPECT_EQ(repeat(follow, seen(kCentre_px - 150.0), 6).state, FollowState::kFollowing);
    EXPECT_EQ(repeat(follow, nothing(), 90).goal.left_radps, -0.4) << images_lost << " images lost before it";
  }
}

TEST(Follow, WhatIsFollowedLongEnoughIsTheObject) {
  Follow follow({}, {});
  repeat(follow, seen(kCentre_px + 100.0), 120);
  repeat(follow, nothing(), 45);
  repeat(follow, seen(kCentre_px - 150.0), 60);
  EXPECT_EQ(repeat(follow, nothing(), 90).goal.left_radps, 0.4);
}

TEST(Follow, TakesUpFromEveryState) {
  for (const int images_lost : {1, 60, 1000}) {
    Follow follow({}, {});
    repeat(follow, seen(kCentre_px), 10);
    repeat(follow, nothing(), images_lost);
    EXPECT_EQ(follow.decide(seen(kCentre_px), kImagePeriod).state, FollowState::kFollowing);
    EXPECT_EQ(follow.decide(nothing(), kImagePeriod).state, FollowState::kStanding) << "and counts anew";
  }
}

TEST(Follow, OldBoxIsNone) {
  Follow follow({}, {});
  auto sighting = seen(kCentre_px + 100.0);
  sighting.age = seconds(0.3);
  EXPECT_EQ(follow.decide(sighting, kImagePeriod).state, FollowState::kFollowing);
  sighting.age = seconds(0.31);
  const auto decision = follow.decide(sighting, kImagePeriod);
  EXPECT_EQ(decision.state, FollowState::kStanding);
  EXPECT_EQ(decision.reason, FollowReason::kStale);
}

TEST(FollowFault, SenselessSightingIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Sighting> senseless(10, seen(kCentre_px));
  senseless[0].box.x = nan;
  senseless[1].box.y = std::numeric_limits<double>::infinity();
  senseless[2].box.width = 0.0;
  senseless[3].box.height = -3.0;
  senseless[4].fx_px = 0.0;
  senseless[5].fx_px = nan;
  senseless[6].cx_px = nan;
  senseless[7].image_width_px = 0;
  senseless[8].image_height_px = -1;
  senseless[9].age = seconds(-0.1);
  for (std::size_t i = 0; i < senseless.size(); ++i) {
    Follow follow({}, {});
    const auto decision = follow.decide(senseless[i], kImagePeriod);
    EXPECT_EQ(decision.reason, FollowReason::kBadInput) << i;
    EXPECT_EQ(decision.state, FollowState::kWaiting) << i;
    EXPECT_EQ(decision.goal.left_radps, 0.0) << i;
  }
}

TEST(FollowFault, LongGapIsNoJumpOfSpeed) {
  Follow follow(stated_size(), kAtTwoMetres);
  const auto decision = follow.decide(seen(kCentre_px, 20.0, 40.0), seconds(60.0));
  EXPECT_LE(decision.goal.forward_mps, 0.3 * 0.3 + 1e-12) << "acceleration limit times max_box_age_s";
}

TEST(FollowFault, TimeRunsBack) {
  Follow follow(stated_size(), kAtTwoMetres);
  const auto decision = follow.decide(seen(kCentre_px, 20.0, 40.0), seconds(-1.0));
  EXPECT_EQ(decision.goal.forward_mps, 0.0);
}

TEST(Follow, EveryStateAndReasonHasItsOwnWords) {
  std::set<std::string_view> words;
  for (int i = 0; i <= static_cast<int>(FollowState::kLost); ++i) words.insert(to_string(static_cast<FollowState>(i)));
  for (int i = 0; i <= static_cast<int>(FollowReason::kBadInput); ++i)
    words.insert(to_string(static_cast<FollowReason>(i)));
  EXPECT_EQ(words.size(), 10u);
  EXPECT_EQ(words.count("unknown"), 0u);
}

}  // namespace
}  // namespace cgsr::behavior
