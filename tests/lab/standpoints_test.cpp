#include "tools/lab/localization/standpoints.h"

#include <cmath>

#include <gtest/gtest.h>

#include "hal/sim/scene/map_count.h"
#include "tools/lab/localization/trial.h"

namespace cgsr::lab {
namespace {

// The occlusion world is made of boxes and rectangles: no seams, so that its edges are those that the simulator counts.
TEST(TrueEdges, AreAllOfTheMaps) {
  const auto place = Place::make("occlusion");
  ASSERT_TRUE(place) << place.error().message;
  EXPECT_EQ(TrueEdges((*place)->scene()).size(), static_cast<std::size_t>(sim::count_map((*place)->scene()).edges));
}

// Of a box that stands on a longer one, flush with it at the front and the back, two edges are part of the longer one's.
TEST(TrueEdges, CountALineOnce) {
  const auto with_boxes = [](int count) {
    return Place::make("occlusion", [count](sim::WorldSpec& spec) {
      sim::ShapeSpec box;
      box.kind = sim::ShapeKind::kBox;
      box.material = spec.material.front().name;
      for (int i = 0; i < count; ++i) {
        box.name = i == 0 ? "below" : "above";
        box.position_m = {3.0, 0.0, i == 0 ? 0.8 : 1.0};
        box.size_m = {i == 0 ? 0.5 : 0.3, 0.3, 0.2};
        spec.shape.push_back(box);
      }
    });
  };
  const auto none = with_boxes(0);
  const auto one = with_boxes(1);
  const auto two = with_boxes(2);
  ASSERT_TRUE(none && one && two);
  const std::size_t others = TrueEdges((*none)->scene()).size();
  EXPECT_EQ(TrueEdges((*one)->scene()).size(), others + 12);
  EXPECT_EQ(TrueEdges((*two)->scene()).size(), others + 12 + 10);
}

TEST(TrueEdges, ClothHidesSome) {
  const auto with = Place::make("occlusion");
  const auto without = Place::make("occlusion", [](sim::WorldSpec& spec) {
    std::erase_if(spec.shape, [](const sim::ShapeSpec& shape) { return shape.name == "yellow cloth"; });
  });
  ASSERT_TRUE(with && without);
  const TrueEdges behind((*without)->scene());
  const geometry::Pose X_WC = (*with)->world().views[1].X_WC;
  EXPECT_LT(behind.seen(**with, X_WC), behind.seen(**without, X_WC));
  EXPECT_GT(behind.seen(**with, X_WC), 5);
}

TEST(StandpointsProperty, SeeWhatWasAskedForAndRepeat) {
  const auto place = Place::make("occlusion");
  ASSERT_TRUE(place) << place.error().message;
  const TrueEdges edges((*place)->scene());
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    Random again(seed);
    const auto at = draw_standpoint(**place, edges, area_of("occlusion"), {}, random);
    const auto at_again = draw_standpoint(**place, edges, area_of("occlusion"), {}, again);
    ASSERT_TRUE(at && at_again);
    EXPECT_GE(at->edges, 6);
    EXPECT_EQ(at->X_WC.matrix(), at_again->X_WC.matrix());
    EXPECT_NEAR(at->X_WC.translation().z(), 1.2, 1e-9);
  }
}

TEST(PriorErrorsProperty, AreAsLargeAsStated) {
  Random random(5);
  geometry::Vector6d squares = geometry::Vector6d::Zero();
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; ++i) squares += draw_prior_error(2.0, random).array().square().matrix() / kDraws;
  EXPECT_NEAR(std::sqrt(squares[0]), 0.30, 0.015);
  EXPECT_NEAR(std::sqrt(squares[1]), 0.30, 0.015);
  EXPECT_EQ(squares[2], 0.0);
  EXPECT_NEAR(std::sqrt(squares[3]) * 180 / M_PI, 2.0, 0.1);
  EXPECT_NEAR(std::sqrt(squares[4]) * 180 / M_PI, 2.0, 0.1);
  EXPECT_NEAR(std::sqrt(squares[5]) * 180 / M_PI, 8.0, 0.4);
}

TEST(FalseCorrection, IsClaimedAndWorseThanThePriorByWhatMatters) {
  Outcome outcome;
  outcome.prior = {0.10, 0.05};
  outcome.error = {0.12, 0.01};
  EXPECT_FALSE(outcome.false_correction()) << "nothing was claimed";
  outcome.answer.corrected = true;
  EXPECT_TRUE(outcome.false_correction());
  outcome.error = {0.09, 0.01};
  EXPECT_FALSE(outcome.false_correction()) << "better than the prior";
  outcome.prior = {0.01, 0.001};
  outcome.error = {0.04, 0.02};
  EXPECT_FALSE(outcome.false_correction()) << "worse, but below 5 cm and 1.5 degrees";
  outcome.error = {0.04, 0.03};
  EXPECT_TRUE(outcome.false_correction()) << "1.7 degrees";
}

}  // namespace
}  // namespace cgsr::lab
