#include "pipeline/behavior/seek_lamp.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace cgsr::behavior {
namespace {

using illumination::CheckState;

constexpr Duration kImagePeriod = seconds(1.0 / 30.0);
constexpr double kDegree = std::numbers::pi / 180.0;

/// A floor of 8 m x 6 m with walls around it and, where wanted, a box in its middle.
world::Map room(bool with_box) {
  world::Map map;
  const auto quad = [&](Eigen::Vector3f a, Eigen::Vector3f b, Eigen::Vector3f c, Eigen::Vector3f d) {
    const auto first = static_cast<std::uint32_t>(map.vertices.size());
    for (const auto& corner : {a, b, c, d}) map.vertices.push_back(corner);
    map.triangles.push_back({first, first + 1, first + 2});
    map.triangles.push_back({first, first + 2, first + 3});
  };
  const auto wall = [&](float x0, float y0, float x1, float y1, float height) {
    quad({x0, y0, 0}, {x1, y1, 0}, {x1, y1, height}, {x0, y0, height});
  };
  quad({0, 0, 0}, {8, 0, 0}, {8, 6, 0}, {0, 6, 0});
  quad({0, 0, 2.5F}, {8, 0, 2.5F}, {8, 6, 2.5F}, {0, 6, 2.5F});
  wall(0, 0, 8, 0, 2.5F);
  wall(8, 0, 8, 6, 2.5F);
  wall(8, 6, 0, 6, 2.5F);
  wall(0, 6, 0, 0, 2.5F);
  if (with_box) {
    wall(3.5F, 2.5F, 4.5F, 2.5F, 0.5F);
    wall(4.5F, 2.5F, 4.5F, 3.5F, 0.5F);
    wall(4.5F, 3.5F, 3.5F, 3.5F, 0.5F);
    wall(3.5F, 3.5F, 3.5F, 2.5F, 0.5F);
  }
  return map;
}

/// A robot that does as it is told, and a lamp whose shadow its probes show within a distance.
class Seek : public ::testing::Test {
 protected:
  void make(bool with_box = false, const KeptArea& area = {}) {
    seek_.emplace(parameters_, std::make_shared<FreeFloor>(room(with_box), parameters_.floor), BoardPlace{}, area);
    states_.clear();
  }

  [[nodiscard]] LampBelief belief() {
    LampBelief lamp;
    lamp.has_board = has_board_;
    lamp.readable = has_board_ && readable_;
    lamp.seen = lamp.readable && burns_ && std::hypot(lamp_x_ - here_.x_m, lamp_y_ - here_.y_m) < seen_within_m_;
    seen_ = lamp.seen ? seen_ + 1 : 0;
    lamp.known = seen_ >= 3 || (known_ && burns_);
    known_ = lamp.known;
    lamp.x_m = lamp_x_;
    lamp.y_m = lamp_y_;
    lamp.z_m = 2.75;
    lamp.sigma_m = 0.03;
    lamp.masked = lamp.known && masks_;
    lamp.probes_check = probes_check_;
    lamp.lamp_proof = lamp_proof_;
    return lamp;
  }

  void image() {
    decision_ = seek_->decide(here_, belief(), kImagePeriod);
    if (states_.empty() || states_.back() != decision_.state) {
      states_.push_back(decision_.state);
      reasons_.push_back(decision_.reason);
    }
    const double step_s = to_seconds(kImagePeriod);
    here_.heading_rad += decision_.goal.left_radps * step_s;
    here_.x_m += decision_.goal.forward_mps * step_s * std::cos(here_.heading_rad);
    here_.y_m += decision_.goal.forward_mps * step_s * std::sin(here_.heading_rad);
    backwards_ = backwards_ || decision_.goal.forward_mps < 0.0;
    hit_ = hit_ || here_.x_m < 0.3 || here_.x_m > 7.7 || here_.y_m < 0.3 || here_.y_m > 5.7;
  }

  void run(double seconds_long) {
    for (int i = 0; i < static_cast<int>(30.0 * seconds_long); ++i) image();
  }

  [[nodiscard]] bool run_until(SeekState state, double max_seconds) {
    for (int i = 0; i < static_cast<int>(30.0 * max_seconds); ++i) {
      image();
      if (decision_.state == state) return true;
    }
    return false;
  }

  SeekLampParameters parameters_;
  std::optional<SeekLamp> seek_;
  PlanarPose here_{true, 1.0, 3.0, 0.0};
  double lamp_x_ = 5.5;
  double lamp_y_ = 3.0;
  double seen_within_m_ = 3.0;
  bool burns_ = true;
  bool has_board_ = true;
  bool readable_ = true;
  bool masks_ = true;
  bool known_ = false;
  illumination::CheckState probes_check_ = illumination::CheckState::kNotThere;
  illumination::CheckState lamp_proof_ = illumination::CheckState::kNotThere;
  int seen_ = 0;
  SeekDecision decision_;
  std::vector<SeekState> states_;
  std::vector<SeekReason> reasons_;
  bool backwards_ = false;
  bool hit_ = false;
};

using SeekFault = Seek;

TEST_F(Seek, GoesThroughTheStatesOfTheAlgorithmInOrder) {
  make();
  ASSERT_TRUE(run_until(SeekState::kTracking, 180.0));
  EXPECT_EQ(states_, (std::vector{SeekState::kExploring, SeekState::kApproaching, SeekState::kLocating,
                                  SeekState::kBackingOff, SeekState::kShading, SeekState::kTracking}));
  EXPECT_EQ(reasons_.back(), SeekReason::kMasked);
  EXPECT_FALSE(backwards_) << "it is blind there";
  EXPECT_FALSE(hit_);
  const double to_lamp = std::atan2(lamp_y_ - here_.y_m, lamp_x_ - here_.x_m);
  EXPECT_LT(std::abs(std::remainder(to_lamp - here_.heading_rad, 2.0 * std::numbers::pi)), 3.0 * kDegree);
  run(3.0);
  EXPECT_EQ(decision_.goal.forward_mps, 0.0);
  EXPECT_EQ(decision_.goal.left_radps, 0.0);
}

TEST_F(Seek, MeasuresFromWhereTheLightComesFromHighEnough) {
  make();
  ASSERT_TRUE(run_until(SeekState::kBackingOff, 180.0));
  const double board_x = here_.x_m + 0.44 * std::cos(here_.heading_rad);
  const double board_y = here_.y_m + 0.44 * std::sin(here_.heading_rad);
  const double angle = std::atan2(std::hypot(lamp_x_ - board_x, lamp_y_ - board_y), 2.75 - 0.90);
  EXPECT_LT(angle, (parameters_.max_locate_angle_deg + 5.0) * kDegree);
}

TEST_F(Seek, BacksOffAsFarAsItShouldWhereThereIsRoom) {
  parameters_.back_off_m = 2.0;
  make();
  ASSERT_TRUE(run_until(SeekState::kBackingOff, 180.0));
  const PlanarPose from = here_;
  ASSERT_TRUE(run_until(SeekState::kShading, 60.0));
  EXPECT_EQ(decision_.reason, SeekReason::kFarEnough);
  EXPECT_NEAR(std::hypot(here_.x_m - from.x_m, here_.y_m - from.y_m), 2.0, 0.3);
}

TEST_F(Seek, AndNoFartherThanMapAndAreaAllow) {
  make(false, {true, -0.2, 20.0, -20.0, 20.0});
  ASSERT_TRUE(run_until(SeekState::kShading, 180.0));
  EXPECT_EQ(decision_.reason, SeekReason::kNoWayFarther);
  EXPECT_GT(here_.x_m, 0.8 - 0.1);
}

TEST_F(Seek, GoesRoundNothingButNeverIntoWhatTheMapHolds) {
  make(true);
  here_ = {true, 2.0, 3.0, 0.0};
  lamp_x_ = 6.5;
  for (int i = 0; i < 30 * 180; ++i) {
    image();
    ASSERT_FALSE(here_.x_m > 3.3 && here_.x_m < 4.7 && here_.y_m > 2.3 && here_.y_m < 3.7);
  }
}

TEST_F(Seek, WithoutAShadowOnlyAmbientLightCounts) {
  burns_ = false;
  make();
  ASSERT_TRUE(run_until(SeekState::kAmbient, 300.0));
  EXPECT_EQ(decision_.reason, SeekReason::kNoShadow);
  EXPECT_EQ(decision_.places, parameters_.max_explore_places);
  EXPECT_FALSE(hit_);
  run(5.0);
  EXPECT_EQ(decision_.goal.forward_mps, 0.0);
  burns_ = true;
  seen_within_m_ = 100.0;
  EXPECT_TRUE(run_until(SeekState::kTracking, 180.0)) << "the lamp was switched on";
}

TEST_F(Seek, WithoutMasksItTracksAllTheSame) {
  masks_ = false;
  make();
  ASSERT_TRUE(run_until(SeekState::kTracking, 180.0));
  EXPECT_EQ(decision_.reason, SeekReason::kNoMask);
}

TEST_F(Seek, StandsStillForAShadowThatIsNotSureYet) {
  make();
  run(2.0);
  ASSERT_EQ(decision_.state, SeekState::kExploring);
  ASSERT_GT(decision_.goal.left_radps, 0.2);
  LampBelief doubtful;
  doubtful.has_board = doubtful.readable = doubtful.seen = true;
  for (int i = 0; i < 20; ++i) decision_ = seek_->decide(here_, doubtful, kImagePeriod);
  EXPECT_LT(decision_.goal.left_radps, 0.1);
  for (int i = 0; i < 30; ++i) decision_ = seek_->decide(here_, doubtful, kImagePeriod);
  EXPECT_GT(decision_.goal.left_radps, 0.2) << "it did not become sure";
}

TEST_F(Seek, ALampThatGoesOutIsLookedForAnew) {
  make();
  ASSERT_TRUE(run_until(SeekState::kApproaching, 180.0));
  burns_ = false;
  ASSERT_TRUE(run_until(SeekState::kExploring, 5.0));
  EXPECT_EQ(decision_.reason, SeekReason::kLampGone);
}

TEST_F(Seek, ChecksTheProbesAndProvesTheLampWhileItStands) {
  probes_check_ = lamp_proof_ = CheckState::kOpen;
  make();
  ASSERT_TRUE(run_until(SeekState::kChecking, 1.0));
  run(0.5);
  EXPECT_EQ(decision_.make_sure, std::nullopt) << "the base still rocks";
  run(0.6);
  EXPECT_EQ(decision_.make_sure, illumination::CheckedLamp::kProbeLamp);
  EXPECT_EQ(decision_.goal.left_radps, 0.0);
  probes_check_ = CheckState::kRunning;
  image();
  EXPECT_EQ(decision_.make_sure, std::nullopt);
  probes_check_ = CheckState::kPassed;
  image();
  EXPECT_EQ(decision_.state, SeekState::kExploring);
  EXPECT_EQ(decision_.reason, SeekReason::kProbesAgree);
  ASSERT_TRUE(run_until(SeekState::kProving, 180.0));
  EXPECT_EQ(decision_.reason, SeekReason::kLampKnown);
  run(1.5);
  EXPECT_EQ(decision_.make_sure, illumination::CheckedLamp::kRoomLamp);
  EXPECT_EQ(decision_.goal.left_radps, 0.0);
  lamp_proof_ = CheckState::kPassed;
  image();
  EXPECT_EQ(decision_.state, SeekState::kBackingOff);
  EXPECT_EQ(decision_.reason, SeekReason::kLampProven);
}

TEST_F(SeekFault, ACheckThatFailsOrCannotBeMadeLeavesAmbientLightAlone) {
  const auto reason_of = [&](CheckState probes, CheckState proof) {
    here_ = {true, 1.0, 3.0, 0.0};
    probes_check_ = CheckState::kOpen;
    lamp_proof_ = CheckState::kOpen;
    known_ = false;
    make();
    image();
    probes_check_ = probes;
    if (probes == CheckState::kPassed) {
      EXPECT_TRUE(run_until(SeekState::kProving, 180.0));
      lamp_proof_ = proof;
    }
    EXPECT_TRUE(run_until(SeekState::kAmbient, 10.0));
    return decision_.reason;
  };
  EXPECT_EQ(reason_of(CheckState::kFailed, CheckState::kOpen), SeekReason::kProbesDoubted);
  EXPECT_EQ(reason_of(CheckState::kFault, CheckState::kOpen), SeekReason::kSwitchFault);
  EXPECT_EQ(reason_of(CheckState::kRunning, CheckState::kOpen), SeekReason::kNoCheck);
  EXPECT_EQ(reason_of(CheckState::kPassed, CheckState::kFailed), SeekReason::kOtherShadow);
  EXPECT_EQ(reason_of(CheckState::kPassed, CheckState::kFault), SeekReason::kSwitchFault);
}

// Without a pose it cannot seek, but it can look.
TEST_F(SeekFault, WithoutAPoseAtTheStartItTracksWhereItStandsUntilThereIsOne) {
  here_.known = false;
  make();
  ASSERT_TRUE(run_until(SeekState::kAmbient, 30.0));
  EXPECT_EQ(decision_.reason, SeekReason::kNoPose);
  here_.known = true;
  image();
  EXPECT_EQ(decision_.state, SeekState::kExploring);
}

TEST_F(SeekFault, WithoutABoardItTracksInAmbientLightAndDoesNotMove) {
  has_board_ = false;
  make();
  run(5.0);
  EXPECT_EQ(decision_.state, SeekState::kAmbient);
  EXPECT_EQ(decision_.reason, SeekReason::kNoBoard);
  EXPECT_EQ(here_.x_m, 1.0);
}

TEST_F(SeekFault, ABoardThatCannotBeReadEndsTheSearch) {
  readable_ = false;
  make();
  ASSERT_TRUE(run_until(SeekState::kAmbient, 30.0));
  EXPECT_EQ(decision_.reason, SeekReason::kBoardUnreadable);
}

TEST_F(SeekFault, WithoutAPoseItHaltsAtOnceAndThenForGood) {
  make();
  run(2.0);
  here_.known = false;
  image();
  EXPECT_TRUE(decision_.halt);
  EXPECT_EQ(decision_.goal.left_radps, 0.0);
  EXPECT_EQ(decision_.state, SeekState::kExploring) << "a moment without a pose is nothing";
  run(parameters_.max_pose_loss_s + 0.2);
  EXPECT_EQ(decision_.state, SeekState::kStopped);
  EXPECT_EQ(decision_.reason, SeekReason::kPoseLost);
  here_.known = true;
  run(2.0);
  EXPECT_EQ(decision_.state, SeekState::kStopped);
  EXPECT_EQ(decision_.goal.forward_mps, 0.0);
}

TEST_F(SeekFault, WithoutAMapNoWayIsFree) {
  seek_.emplace(parameters_, nullptr, BoardPlace{}, KeptArea{});
  run(120.0);
  EXPECT_NEAR(here_.x_m, 1.0, 1e-9);
  EXPECT_EQ(decision_.state, SeekState::kAmbient);
}

TEST(FreeFloor, KeepsClearOfWallsAndGoesUnderTheCeiling) {
  const FreeFloor floor(room(true), {});
  EXPECT_TRUE(floor.is_free(1.0, 1.0));
  EXPECT_FALSE(floor.is_free(0.2, 3.0));
  EXPECT_FALSE(floor.is_free(4.0, 2.3));
  EXPECT_FALSE(floor.is_free(-1.0, 3.0));
  EXPECT_FALSE(floor.is_free(std::nan(""), 3.0));
  EXPECT_NEAR(floor.way_m(1.0, 3.0, 0.0, 10.0), 2.1, 0.1);
  EXPECT_NEAR(floor.way_m(1.0, 1.0, 0.0, 10.0), 6.6, 0.1);
  EXPECT_NEAR(floor.way_m(1.0, 1.0, 0.0, 1.0), 1.0, 1e-9);
  EXPECT_EQ(floor.way_m(0.1, 1.0, 0.0, 1.0), 0.0);
  EXPECT_FALSE(FreeFloor(world::Map{}, {}).is_free(0.0, 0.0));
}

}  // namespace
}  // namespace cgsr::behavior
