#include "pipeline/global_localization/turn_fit.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/runtime/stage_budget.h"
#include "tests/localization/small_room.h"

namespace cgsr::global_localization {
namespace {

using geometry::Pose;
using localization::testing::in_small_room;
using localization::testing::Picture;
using localization::testing::small_room;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kStep = 10.0 * kDegree;  // between images

Pose about_pivot(double behind_m, double turned_rad) {
  return geometry::pose_on_floor(-behind_m, 0.0, turned_rad) * geometry::pose_on_floor(behind_m, 0.0, 0.0);
}

/// A robot that has turned once in the small room, and wandered meanwhile, which its odometry does not tell.
class AfterATurn : public ::testing::Test {
 protected:
  /// \param told_share  of what the robot turns.  \param wandered_m  untold.  \param pivot_m  how far behind it the middle of its turn is.
  void turn(double told_share, double wandered_m, double pivot_m = 0.0) {
    const double least = 2.0 * std::numbers::pi + 90.0 * kDegree;
    for (int i = 0; i * kStep < least; ++i) {
      const double turned = i * kStep;
      const double wandered = wandered_m * turned / (2.0 * std::numbers::pi);
      const Pose X_WR = X_WR0_ * geometry::pose_on_floor(0.0, wandered, 0.0) * about_pivot(pivot_m, turned);
      const Motion motion{.X_OR = geometry::pose_on_floor(5.0, 7.0, 2.0) * about_pivot(pivot_m, told_share * turned)};
      if (turn_.looks_at(motion)) X_WR_.push_back(X_WR);
      const Picture picture(map_, X_WR * X_RC_, camera_, 1.5, static_cast<std::uint32_t>(i));
      if (turn_.see(picture.view(), motion, nullptr)) break;
    }
    ASSERT_EQ(X_WR_.size(), static_cast<std::size_t>(kViews));
    turn_.close();
  }

  /// In every image, from a start that is as far off as panoramas leave it.
  void expect_fitted(WorkBudget& budget) {
    fit_.begin(X_WR0_ * geometry::pose_on_floor(0.08, -0.06, 2.0 * kDegree));
    ASSERT_TRUE(fit_.go_on(turn_, budget));
    expect_right();
  }

  void expect_right() const {
    for (std::size_t i = 0; i < X_WR_.size(); ++i) {
      const geometry::Vector6d off = geometry::step_between(X_WR_[i], fit_.X_WR(turn_, turn_.keyframes()[i]));
      EXPECT_LT(off.head<3>().norm(), 0.025) << i;
      EXPECT_LT(off.tail<3>().norm(), 0.7 * kDegree) << i;
    }
  }

  world::Map map_ = small_room();
  geometry::Camera camera_ = geometry::Camera{}.scaled_to(320, 240);
  Pose X_RC_ = in_small_room(0.0, 0.0, 0.0);
  localization::Localizer localizer_{map_, camera_, {}};
  GlobalLocalizerParameters parameters_;
  Turn turn_{camera_, X_RC_, parameters_.max_drift_m};
  TurnFit fit_{localizer_, X_RC_, parameters_};
  Pose X_WR0_ = geometry::pose_on_floor(2.2, 2.1, -2.0);
  std::vector<Pose> X_WR_;  ///< where the robot was at the images of the turn.
  UnlimitedBudget whole_;
};

TEST_F(AfterATurn, FitsPlaceAndHeading) {
  turn(1.0, 0.0);
  expect_fitted(whole_);
}

// The closed turn tells the headings to some degrees, and the places not at all.
TEST_F(AfterATurn, FitsWhatTheOdometryIsOff) {
  turn(1.03, 0.07);
  expect_fitted(whole_);
}

// A base that turns about a caster: what the heading is off at first, the place is off later.
TEST_F(AfterATurn, FitsATurnBesideItsMiddle) {
  turn(1.02, 0.0, 0.13);
  expect_fitted(whole_);
}

TEST_F(AfterATurn, GoesOnFromImageToImage) {
  turn(1.0, 0.03);
  fit_.begin(X_WR0_ * geometry::pose_on_floor(0.08, -0.06, 2.0 * kDegree));
  int images = 0;
  for (bool done = false; !done && images < 100; ++images) {
    auto budget = runtime::StageBudget::of_units(13);
    done = fit_.go_on(turn_, budget);
    EXPECT_LE(budget.granted(), 13U);
  }
  EXPECT_LE(images, 40);
  expect_right();
}

}  // namespace
}  // namespace cgsr::global_localization
