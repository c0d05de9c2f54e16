#include "pipeline/localization/alternative_hypothesis.h"

#include <cstdint>
#include <numbers>

#include <gtest/gtest.h>

#include "pipeline/localization/perceive.h"
#include "pipeline/render/depth_raster.h"
#include "tests/localization/small_room.h"

namespace cgsr::localization {
namespace {

using geometry::Pose;
using testing::in_small_room;
using testing::Picture;
using testing::small_room;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr PriorSigmas kFollowed{.x_m = 0.03, .y_m = 0.03, .z_m = 0.01, .heading_rad = 0.012, .tilt_rad = 0.003};

// What follows a robot that stands, and the alternative hypothesis beside it.
class AnAlternative : public ::testing::Test {
 protected:
  AnAlternative()
      : map_(small_room()),
        camera_(geometry::Camera{}.scaled_to(320, 240)),
        perception_(camera_),
        raster_(map_, {}),
        alternation_(map_, parameters_, raster_, camera_, Perception::kMostSegments),
        alternative_(parameters_, alternation_) {}

  /// Sees the robot's place once more and goes on from the pose that was followed. \return the estimate without the alternative hypothesis.
  Estimate see() {
    const Picture picture(map_, X_WC_, camera_, 1.5, ++images_);
    EXPECT_EQ(perception_.perceive(picture.view(), nullptr), Reason::kNone);
    const Belief belief(prior_at(followed_, kFollowed));
    alternation_.look(followed_);
    AlternateOptions options;
    options.rounds = parameters_.max_iterations;
    options.radius_px = static_cast<float>(parameters_.min_match_radius_px);
    const Estimate alone = alternation_.refine(followed_, belief, perception_.edges(), options, budget_);
    if (alone.solved) followed_ = alternative_.better_than(alone, belief, perception_.edges(), budget_).solution.X_WC;
    return alone;
  }
  [[nodiscard]] double off_m() const { return geometry::step_between(X_WC_, followed_).head<3>().norm(); }

  world::Map map_;
  geometry::Camera camera_;
  LocalizerParameters parameters_;
  Perception perception_;
  render::DepthRaster raster_;
  Alternation alternation_;
  AlternativeHypothesis alternative_;
  UnlimitedBudget budget_;
  Pose X_WC_ = in_small_room(1.0, 1.6, 0.2);
  Pose followed_ = X_WC_;
  std::uint32_t images_ = 0;
};

TEST_F(AnAlternative, BringsBackWhatHadSettledOnTheWrongEdges) {
  followed_ = in_small_room(1.0, 1.52, 0.2 - 1.5 * kDegree);
  const Estimate alone = see();
  ASSERT_TRUE(alone.solved);
  ASSERT_GT(geometry::step_between(X_WC_, alone.solution.X_WC).head<3>().norm(), 0.05)
      << "not settled on the wrong ones";
  for (int i = 0; i < 60 && off_m() > 0.01; ++i) see();
  EXPECT_LT(off_m(), 0.01);
  EXPECT_GE(images_, 5U) << "one image alone must not decide";
}

TEST_F(AnAlternative, LeavesARightPoseWhereItIs) {
  for (int i = 0; i < 60; ++i) {
    see();
    ASSERT_LT(off_m(), 0.01) << i;
  }
}

}  // namespace
}  // namespace cgsr::localization
