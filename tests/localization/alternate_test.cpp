#include "pipeline/localization/alternate.h"

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

/// The room with the picture on the east wall some centimetres from where the map has it.
world::Map room_with_picture_moved(float by_m) {
  world::Map map = small_room();
  constexpr std::size_t kPicture = 8;  // of the room's rectangles, four corners each
  for (std::size_t corner = 4 * kPicture; corner < 4 * (kPicture + 1); ++corner) map.vertices[corner].y() += by_m;
  return map;
}

// Lines that lie some pixels beside the map's are other lines: a search that settles does not lean on them.
TEST(Alternation, ASettlingPoseIsHeldByTheLinesThatFit) {
  const world::Map told = small_room();
  const world::Map seen = room_with_picture_moved(0.035F);
  const geometry::Camera camera = geometry::Camera{}.scaled_to(320, 240);
  const LocalizerParameters parameters;
  Perception perception(camera);
  render::DepthRaster raster(told, {});
  Alternation alternation(told, parameters, raster, camera, Perception::kMostSegments);
  UnlimitedBudget budget;
  const Pose truth = in_small_room(1.0, 1.6, 0.2);
  const Belief belief(prior_at(in_small_room(1.05, 1.56, 0.21), PriorSigmas::floor()));
  const Picture picture(seen, truth, camera, 1.5, 1);
  ASSERT_EQ(perception.perceive(picture.view(), nullptr), Reason::kNone);
  const auto off_m = [&](bool settle) {
    const AlternateOptions options{.rounds = 8, .radius_px = 12.0F, .settle = settle};
    const Estimate estimate = alternation.refine(belief.prior.X_WC, belief, perception.edges(), options, budget);
    EXPECT_TRUE(estimate.solved);
    return geometry::step_between(truth, estimate.solution.X_WC).head<3>().norm();
  };
  const double without = off_m(false);
  const double settled = off_m(true);
  EXPECT_LT(settled, 0.7 * without) << without;
  EXPECT_LT(settled, 0.01);
}

// From a belief that is sure and off, a little noise in the matches moves the pose far: its cost is that of where it comes to, the prior's in it.
TEST(Alternation, ItsCostIsThatOfThePoseThatTheMeasuredNoiseGives) {
  const world::Map map = small_room();
  const geometry::Camera camera = geometry::Camera{}.scaled_to(320, 240);
  const LocalizerParameters parameters;
  Perception perception(camera);
  render::DepthRaster raster(map, {});
  Alternation alternation(map, parameters, raster, camera, Perception::kMostSegments);
  UnlimitedBudget budget;
  const Pose truth = in_small_room(1.0, 1.6, 0.2);
  const Picture picture(map, truth, camera, 0.5, 1);
  ASSERT_EQ(perception.perceive(picture.view(), nullptr), Reason::kNone);
  for (const double scale : {0.01, 0.03, 0.1}) {
    const Belief belief(prior_at(in_small_room(1.01, 1.6, 0.2), PriorSigmas::floor().times(scale)));
    const AlternateOptions options{.rounds = 8, .radius_px = 8.0F, .measured_noise = true};
    const Estimate estimate = alternation.refine(belief.prior.X_WC, belief, perception.edges(), options, budget);
    ASSERT_TRUE(estimate.solved);
    const auto lines = alternation.distances_from(estimate.solution.X_WC, perception.edges(), 4.0F);
    const double there =
        cost_of(lines, estimate.solution.X_WC, belief.prior, belief.information, camera, options.robust).sum;
    EXPECT_NEAR(estimate.solution.cost, there, 0.01 * there) << scale;
  }
}

}  // namespace
}  // namespace cgsr::localization
