#include "pipeline/global_localization/global_localizer.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "pipeline/runtime/stage_budget.h"
#include "tests/localization/small_room.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::global_localization {
namespace {

using geometry::Pose;
using localization::testing::in_small_room;
using localization::testing::leaning;
using localization::testing::MapBuilder;
using localization::testing::Picture;
using localization::testing::small_room;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kTurn = 10.0 * kDegree;  // between images

/// Half a turn shows it again: nobody can say where in it he is.
world::Map room_that_is_twice_the_same() {
  MapBuilder b;
  const std::uint32_t wall = b.grey(0.7F);
  const std::uint32_t dark = b.grey(0.15F);
  const std::uint32_t floor = b.rectangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, b.grey(0.35F));
  const std::uint32_t east = b.rectangle({4, 0, 0}, {0, 0, 2.5F}, {0, 4, 0}, wall);
  const std::uint32_t west = b.rectangle({0, 0, 0}, {0, 4, 0}, {0, 0, 2.5F}, wall);
  b.rectangle({0, 4, 0}, {4, 0, 0}, {0, 0, 2.5F}, wall);
  b.rectangle({0, 0, 0}, {0, 0, 2.5F}, {4, 0, 0}, wall);
  b.rectangle({3.998F, 1.1F, 0.5F}, {0, 0, 0.7F}, {0, 0.5F, 0}, dark, east);
  b.rectangle({3.998F, 2.4F, 0.0F}, {0, 0, 1.9F}, {0, 0.8F, 0}, dark, east);
  b.rectangle({0.002F, 2.4F, 0.5F}, {0, 0.5F, 0}, {0, 0, 0.7F}, dark, west);
  b.rectangle({0.002F, 0.8F, 0.0F}, {0, 0.8F, 0}, {0, 0, 1.9F}, dark, west);
  b.box({3.1F, 3.2F, 0}, {0.5F, 0.45F, 0.4F}, dark, floor);
  b.box({0.4F, 0.35F, 0}, {0.5F, 0.45F, 0.4F}, dark, floor);
  return b.map;
}

class PutDownAnywhere : public ::testing::Test {
 protected:
  explicit PutDownAnywhere(world::Map map = small_room(), const GlobalLocalizerParameters& parameters = {})
      : map_(std::move(map)),
        camera_(geometry::Camera{}.scaled_to(320, 240)),
        X_RC_(in_small_room(0.0, 0.0, 0.0)),
        localizer_(map_, camera_, {}) {
    const auto may_stand = [](double x_m, double y_m) { return x_m > 0.4 && x_m < 3.0 && y_m > 0.4 && y_m < 3.6; };
    auto places = grid_of_places(map_, parameters.spacing_m, may_stand);
    searcher_ = std::make_unique<GlobalLocalizer>(map_, camera_, X_RC_, std::move(places), localizer_,
                                                  localization::PoseTrackerParameters{}, parameters);
  }

  void begin_again() {
    searcher_->restart();
    images_ = 0;
    turned_ = 0.0;
  }

  /// An image from where the robot is, and what its odometry, which began elsewhere, says of that.
  Phase see(const Pose& X_WR, WorkBudget& budget) {
    const Pose X_R0R = X_W0_.inverse() * X_WR;
    // The odometry began elsewhere, and turns too far.
    turned_ += std::remainder(geometry::heading_of(X_R0R) - std::remainder(turned_, 2.0 * std::numbers::pi),
                              2.0 * std::numbers::pi);
    const double pitch_rad = images_ == 0 ? lean_rad_ : (images_ % 3 - 1) * 0.3 * lean_rad_;
    const Motion motion{
        .X_OR = geometry::pose_on_floor(5.0, 7.0, 2.0) *
                geometry::pose_on_floor(X_R0R.translation().x(), X_R0R.translation().y(), odometry_turns_ * turned_) *
                leaning(pitch_rad, kAxle_m),
        .pitch_rad = pitch_rad,
        .axle_height_m = kAxle_m};
    ++images_;
    const Eigen::Vector2d slid_m = std::min(std::abs(turned_) / (2.0 * std::numbers::pi), 1.0) * slid_m_;
    X_WC_ = geometry::pose_on_floor(slid_m.x(), slid_m.y(), 0.0) * X_WR * leaning(pitch_rad, kAxle_m) * X_RC_;
    const bool moved = std::abs(std::abs(turned_) - 2.0 * std::numbers::pi) < kMovedView;
    const Pose X_WC_seen = moved ? geometry::pose_on_floor(moved_m_.x(), moved_m_.y(), 0.0) * X_WC_ : X_WC_;
    if (searcher_->looks_at(motion))
      picture_.emplace(map_, X_WC_seen, camera_, 1.5, static_cast<std::uint32_t>(images_));
    return searcher_->update(picture_->view(), motion, budget);
  }

  /// Turns where it stands as long as that is wanted, and stands then. \return the phase in which it ended.
  Phase turn(const Pose& X_W0, WorkBudget& budget) {
    X_W0_ = X_W0;
    double turned = 0.0;
    while (searcher_->phase() < Phase::kFound && images_ < 2000) {
      X_WR_ = X_W0 * geometry::pose_on_floor(0.0, 0.0, turned);
      see(X_WR_, budget);
      const double step = searcher_->turns_back() && turns_back_if_told_ ? -kTurn : kTurn;
      if (searcher_->wants_turn()) turned += way_round_ * step;
    }
    return searcher_->phase();
  }

  /// Found where it is, by so much.
  void expect_right(double distance_m = 0.03, double turn_rad = 1.0 * kDegree) const {
    const geometry::Vector6d off = geometry::step_between(X_WC_, searcher_->found().X_WC);
    EXPECT_LT(off.head<3>().norm(), distance_m);
    EXPECT_LT(off.tail<3>().norm(), turn_rad);
  }

  static constexpr double kAxle_m = 0.24;
  static constexpr double kMovedView = 16.0 * kDegree;

  world::Map map_;
  geometry::Camera camera_;
  Pose X_RC_;
  localization::Localizer localizer_;
  std::unique_ptr<GlobalLocalizer> searcher_;
  UnlimitedBudget whole_;
  Pose X_W0_ = Pose::Identity();
  Pose X_WR_ = Pose::Identity();  ///< where it is at last.
  double turned_ = 0.0;
  double odometry_turns_ = 1.0;  ///< of what the robot turns.
  double lean_rad_ = 0.0;        ///< in the first image; less in those that follow.
  int way_round_ = 1;            ///< -1: to the right.
  bool turns_back_if_told_ = true;
  Eigen::Vector2d moved_m_{0.0, 0.0};  ///< what it sees after a whole turn is that much elsewhere, against the map.
  Eigen::Vector2d slid_m_{0.0, 0.0};   ///< in W, over the first whole turn, and its odometry does not tell.
  Pose X_WC_ = Pose::Identity();       ///< where the camera is.
  int images_ = 0;
  std::optional<Picture> picture_;  ///< the last that was looked at.
};

TEST_F(PutDownAnywhere, FindsItselfByTurningOnce) {
  for (const auto& [x_m, y_m, heading] : {std::tuple{0.9, 1.7, 0.3}, {2.2, 2.1, -2.0}, {1.5, 0.8, 3.0}}) {
    begin_again();
    ASSERT_EQ(turn(geometry::pose_on_floor(x_m, y_m, heading), whole_), Phase::kFound) << x_m << ", " << y_m;
    expect_right();
    EXPECT_LE(images_, 36 + 250);
  }
}

// Wheels whose track is told wrong: the images say when the turn is whole.
TEST_F(PutDownAnywhere, BelievesTheImagesHowFarItTurned) {
  for (const double share : {0.95, 1.05}) {
    begin_again();
    odometry_turns_ = share;
    ASSERT_EQ(turn(geometry::pose_on_floor(2.2, 2.1, -2.0), whole_), Phase::kFound) << share;
    expect_right();
  }
}

TEST_F(PutDownAnywhere, TurnsEitherWayRound) {
  way_round_ = -1;
  odometry_turns_ = 1.04;
  ASSERT_EQ(turn(geometry::pose_on_floor(2.2, 2.1, -2.0), whole_), Phase::kFound);
  expect_right();
}

// A base that balances leans most where it begins to turn: that is not the mount's.
TEST_F(PutDownAnywhere, LeansInTheFirstImage) {
  lean_rad_ = 2.5 * kDegree;
  ASSERT_EQ(turn(geometry::pose_on_floor(2.2, 2.1, -2.0), whole_), Phase::kFound);
  expect_right();
}

// It stands before a bare wall when the turn is whole, and turns on with odometry that turns too far.
TEST_F(PutDownAnywhere, TurnsOnBeforeABareWall) {
  odometry_turns_ = 1.06;
  ASSERT_EQ(turn(geometry::pose_on_floor(1.5, 0.8, 3.0), whole_), Phase::kFound);
  expect_right();
}

// The nearest view that tells where it is may be one that it just saw.
TEST_F(PutDownAnywhere, TurnsBackWhereThatIsShorter) {
  for (const auto& [way_round, y_m, heading] : {std::tuple{1, 0.8, 3.0}, {-1, 1.7, 5.0}}) {
    way_round_ = way_round;
    int images = 0;
    for (const bool back : {false, true}) {
      turns_back_if_told_ = back;
      begin_again();
      ASSERT_EQ(turn(geometry::pose_on_floor(1.5, y_m, heading), whole_), Phase::kFound) << way_round;
      expect_right();
      if (!back) images = images_;
    }
    EXPECT_LT(images_, images) << way_round;
  }
}

// Something was pushed aside in the view that the turn ends with, and the map is matched with it: what it saw elsewhere contradicts.
TEST_F(PutDownAnywhere, TurnsAwayFromAViewThatTheOthersContradict) {
  for (const Eigen::Vector2d& moved_m : {Eigen::Vector2d{0.07, 0.0}, {0.0, 0.07}}) {
    begin_again();
    moved_m_ = moved_m;
    ASSERT_EQ(turn(geometry::pose_on_floor(0.9, 1.7, 0.3), whole_), Phase::kFound) << moved_m.transpose();
    expect_right();
    EXPECT_GT(std::abs(std::abs(turned_) - 2.0 * std::numbers::pi), kMovedView);
  }
}

// Its wheels slipped while it turned, which its odometry does not tell: the views of the turn contradict each other, and two that it looks at again agree.
TEST_F(PutDownAnywhere, IsFoundByTwoViewsThatItLooksAtAgain) {
  for (const Eigen::Vector2d& slid_m : {Eigen::Vector2d{0.1, 0.0}, {-0.08, 0.0}}) {
    begin_again();
    slid_m_ = slid_m;
    ASSERT_EQ(turn(geometry::pose_on_floor(0.9, 1.7, 5.0), whole_), Phase::kFound) << slid_m.transpose();
    expect_right();
  }
}

// What it saw to the left of where it began is not seen again to the right.
TEST_F(PutDownAnywhere, BeginsAnewWhereItTurnsBack) {
  X_W0_ = geometry::pose_on_floor(2.2, 2.1, -2.0);
  for (int i = 0; i <= 9; ++i) see(X_W0_ * geometry::pose_on_floor(0.0, 0.0, i * kTurn), whole_);
  int images = 0;
  for (double turned = 9 * kTurn; searcher_->wants_turn() && images < 100; turned -= kTurn, ++images)
    see(X_W0_ * geometry::pose_on_floor(0.0, 0.0, turned), whole_);
  EXPECT_GE(images, 9 + 36);  // back, and all the way round
  EXPECT_LT(images, 100);
}

// A robot does as much in each image as its stage's budget holds, and comes to the same answer.
TEST_F(PutDownAnywhere, KeepsToItsUnits) {
  X_W0_ = geometry::pose_on_floor(2.2, 2.1, -2.0);
  double turned = 0.0;
  while (searcher_->phase() < Phase::kFound && images_ < 4000) {
    auto budget = runtime::StageBudget::of_units(18);
    X_WR_ = X_W0_ * geometry::pose_on_floor(0.0, 0.0, turned);
    see(X_WR_, budget);
    ASSERT_LE(budget.granted(), 18U);
    if (searcher_->wants_turn()) turned += kTurn;
  }
  ASSERT_EQ(searcher_->phase(), Phase::kFound);
  EXPECT_LT((X_WR_.translation() - (searcher_->found().X_WC * X_RC_.inverse()).translation()).norm(), 0.03);
}

TEST_F(PutDownAnywhere, LooksAtThirteenImagesOfTheTurn) {
  X_W0_ = geometry::pose_on_floor(0.9, 1.7, 0.3);
  int looked = 0;
  for (double turned = 0.0; searcher_->wants_turn(); turned += kTurn) {
    const Pose X_WR = X_W0_ * geometry::pose_on_floor(0.0, 0.0, turned);
    looked += searcher_->looks_at({.X_OR = geometry::pose_on_floor(5.0, 7.0, 2.0) * X_W0_.inverse() * X_WR}) ? 1 : 0;
    see(X_WR, whole_);
  }
  EXPECT_EQ(looked, kKeyframes + 1);
  EXPECT_FALSE(searcher_->looks_at({}));
}

// Pushed aside while it turns: what it saw before was seen from elsewhere.
TEST_F(PutDownAnywhere, BeginsAnewWhereItWasMoved) {
  X_W0_ = geometry::pose_on_floor(0.9, 1.7, 0.3);
  for (int i = 0; i < 18; ++i) see(X_W0_ * geometry::pose_on_floor(0.0, 0.0, i * kTurn), whole_);
  const Pose X_W1 = X_W0_ * geometry::pose_on_floor(0.8, 0.2, 18 * kTurn);
  for (int i = 0; i < 43; ++i) {
    see(X_W1 * geometry::pose_on_floor(0.0, 0.0, i * kTurn), whole_);
    if (i < 35) {
      EXPECT_TRUE(searcher_->wants_turn()) << i;
    }
  }
  EXPECT_FALSE(searcher_->wants_turn());
}

// A base that drives away whenever it turns: no turn becomes whole, and it is not asked to turn for ever.
TEST_F(PutDownAnywhere, GivesUpWhereNoTurnBecomesWhole) {
  X_W0_ = geometry::pose_on_floor(0.9, 1.7, 0.3);
  int images = 0;
  for (; searcher_->wants_turn() && images < 300; ++images) {
    const double away_m = images / 18 % 2 == 0 ? 0.0 : 0.8;
    see(X_W0_ * geometry::pose_on_floor(away_m, 0.2, images * kTurn), whole_);
  }
  EXPECT_EQ(searcher_->phase(), Phase::kNotFound);
  EXPECT_NEAR(images, 3 * 36, 3);
}

// All black: nothing to see anywhere.
TEST_F(PutDownAnywhere, SaysThatItFindsNothing) {
  const std::vector<std::uint8_t> black(320 * 240, 2);
  const ImageView image{
      .data = black.data(), .width_px = 320, .height_px = 240, .stride_bytes = 320, .format = PixelFormat::kGrey8};
  for (int i = 0; searcher_->phase() < Phase::kFound && i < 2000; ++i)
    searcher_->update(image, {.X_OR = geometry::pose_on_floor(0.0, 0.0, i * kTurn)}, whole_);
  EXPECT_EQ(searcher_->phase(), Phase::kNotFound);
}

TEST_F(PutDownAnywhere, AllocatesNothing) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "not under a sanitizer";
  const Picture picture(map_, in_small_room(0.9, 1.7, 0.3), camera_, 1.5, 1);
  const test::AllocationGuard guard;
  for (int i = 0; i < 60; ++i)
    searcher_->update(picture.view(), {.X_OR = geometry::pose_on_floor(0.0, 0.0, i * kTurn)}, whole_);
  EXPECT_EQ(guard.allocations(), 0U);
}

class PutDownInATwin : public PutDownAnywhere {
 protected:
  PutDownInATwin() : PutDownAnywhere(room_that_is_twice_the_same()) {}
};

TEST_F(PutDownInATwin, SaysThatThereAreTwoPlaces) {
  EXPECT_EQ(turn(geometry::pose_on_floor(1.5, 1.4, 0.3), whole_), Phase::kAmbiguous);
  int corrected = 0;
  for (const Candidate& candidate : searcher_->candidates()) corrected += candidate.corrected > 3 ? 1 : 0;
  EXPECT_EQ(corrected, 2);
}

GlobalLocalizerParameters corrected_in_images(int images) {
  GlobalLocalizerParameters parameters;
  parameters.min_corrected = images;
  return parameters;
}

GlobalLocalizerParameters no_two_agree() {
  GlobalLocalizerParameters parameters;
  parameters.agree_m = 0.0;
  return parameters;
}

class PutDownWhereNoTwoAgree : public PutDownAnywhere {
 protected:
  PutDownWhereNoTwoAgree() : PutDownAnywhere(small_room(), no_two_agree()) {}
};

TEST_F(PutDownWhereNoTwoAgree, IsNotFound) {
  EXPECT_EQ(turn(geometry::pose_on_floor(0.9, 1.7, 0.3), whole_), Phase::kNotFound);
}

/// More images than there are would have to correct its pose.
class HardlyCorrected : public PutDownAnywhere {
 protected:
  explicit HardlyCorrected(world::Map map = small_room())
      : PutDownAnywhere(std::move(map), corrected_in_images(kViews + 1)) {}
};

class HardlyCorrectedInATwin : public HardlyCorrected {
 protected:
  HardlyCorrectedInATwin() : HardlyCorrected(room_that_is_twice_the_same()) {}
};

// Fewer will do where no other place is nearly as alike.
TEST_F(HardlyCorrected, IsFoundWhereItsPanoramaStandsAlone) {
  ASSERT_EQ(turn(geometry::pose_on_floor(2.2, 2.1, -2.0), whole_), Phase::kFound);
  expect_right();
}

TEST_F(HardlyCorrectedInATwin, IsNot) {
  EXPECT_EQ(turn(geometry::pose_on_floor(1.5, 1.4, 0.3), whole_), Phase::kNotFound);
}

}  // namespace
}  // namespace cgsr::global_localization
