#include "pipeline/color/ball/integrated_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "tests/color/ball_scene.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/counted_budget.h"

namespace cgsr::color {
namespace {

constexpr Circle kInLight{90.0, 55.0, 15.0};
constexpr Circle kInShade{240.0, 185.0, 15.0};
constexpr double kShade = 0.45;
constexpr double kFocal_px = 300.0;  // a ball of 20 cm at 2 m: 30 px

IntegratedTracker tracker(const IntegratedParameters& parameters = {}) {
  return IntegratedTracker::create(test::ball_model(), parameters, test::kBallWidth_px, test::kBallHeight_px, kFocal_px)
      .value();
}

test::Painting with_ball(const Circle& circle, double factor) {
  auto painting = test::ball_room(kShade);
  test::paint_ball(painting, circle, factor);
  return painting;
}

class Bench {
 public:
  explicit Bench(const IntegratedParameters& parameters = {}) : tracker_(tracker(parameters)) {}
  BallSighting look(test::Painting painting, const ShadeMaskView& mask, const ShadeAtPlace* places = nullptr) {
    UnlimitedBudget budget;
    return tracker_.track(painting.photograph(1.5, ++seed_), mask, budget, places);
  }

 private:
  IntegratedTracker tracker_;
  std::uint32_t seed_ = 100;
};

TEST(IntegratedTracker, FindsTheBallInTheLight) {
  const test::QuarterMask mask;
  for (const bool with_mask : {true, false}) {
    Bench bench;
    const auto seen = bench.look(with_ball(kInLight, 1.0), with_mask ? mask.view() : ShadeMaskView{});
    ASSERT_TRUE(seen.found) << with_mask;
    EXPECT_EQ(seen.mask_used, with_mask);
    EXPECT_GT(intersection_over_union(seen.box, test::around(kInLight)), 0.85);
    EXPECT_FALSE(seen.dark);
    EXPECT_TRUE(seen.exact);
    EXPECT_GT(seen.light.r, 0.55);
  }
}

TEST(IntegratedTracker, FindsTheBallInShadeInsideTheMask) {
  const test::QuarterMask mask;
  Bench bench;
  const auto seen = bench.look(with_ball(kInShade, kShade), mask.view());
  ASSERT_TRUE(seen.found);
  EXPECT_GT(intersection_over_union(seen.box, test::around(kInShade)), 0.85);
  EXPECT_TRUE(seen.dark);
  EXPECT_GT(seen.shade_share, 0.99);
  EXPECT_LT(seen.light.r, 0.56);
}

// A brown ball in the light looks like an orange one in shade.
TEST(IntegratedTracker, ABrownBallInTheLightIsFoundWithoutAMaskAlone) {
  const test::QuarterMask mask;
  Bench with_mask;
  Bench without;
  for (int i = 0; i < 10; ++i) {
    const Circle moved{kInLight.x_px + 3 * i, kInLight.y_px, kInLight.radius_px};
    EXPECT_FALSE(with_mask.look(with_ball(moved, kShade), mask.view()).found) << i;
    const auto seen = without.look(with_ball(moved, kShade), {});
    ASSERT_TRUE(seen.found) << i << ": this test could not fail";
    EXPECT_FALSE(seen.mask_used);
    EXPECT_TRUE(seen.dark);
  }
}

// A lighter brown comes nearer to the darkest bright histogram than some lit orange does, and still nearer to a dark one.
TEST(IntegratedTracker, ALighterBrownBallInTheLightIsNotFoundEither) {
  constexpr double kBetween = 0.64;  // bright histograms reach down to 0.6 / 0.8, dark ones up to 0.55 / 0.8
  const test::QuarterMask mask;
  Bench bench;
  for (int i = 0; i < 10; ++i) {
    const Circle moved{kInLight.x_px + 3 * i, kInLight.y_px, kInLight.radius_px};
    EXPECT_FALSE(bench.look(with_ball(moved, kBetween), mask.view()).found) << i;
  }
  EXPECT_TRUE(bench.look(with_ball(kInShade, kBetween), mask.view()).found) << "where there may be shade";
  EXPECT_TRUE(bench.look(with_ball(kInLight, 0.75), mask.view()).found) << "under the darkest light of the grid";
}

/// What says of every place the same.
class AllPlaces final : public ShadeAtPlace {
 public:
  explicit AllPlaces(bool shaded) : AllPlaces(shaded, shaded) {}
  AllPlaces(bool may_be, bool surely) : shaded_(may_be), surely_(surely) {}
  bool may_be_shaded(const Circle& circle, double diameter_m) const override {
    asked_of_ = circle;
    EXPECT_EQ(diameter_m, 0.20);
    return shaded_;
  }
  [[nodiscard]] bool is_shaded(const Circle& /*circle*/, double /*diameter_m*/) const override { return surely_; }
  [[nodiscard]] const Circle& asked_of() const { return asked_of_; }

 private:
  bool shaded_;
  bool surely_;
  mutable Circle asked_of_;
};

// Some point of the ray is shaded, the ball's place is not: the mask alone takes the brown ball for the orange one.
TEST(IntegratedTracker, WhereThePlaceIsLitABrownBallBehindShadeIsNotFound) {
  const test::QuarterMask mask;
  const AllPlaces lit(false);
  const AllPlaces shaded(true);
  EXPECT_TRUE(Bench().look(with_ball(kInShade, kShade), mask.view()).found) << "this test could not fail";
  EXPECT_TRUE(Bench().look(with_ball(kInShade, kShade), mask.view(), &shaded).found);
  EXPECT_FALSE(Bench().look(with_ball(kInShade, kShade), mask.view(), &lit).found);
  const auto seen = Bench().look(with_ball(kInLight, 1.0), mask.view(), &lit);
  ASSERT_TRUE(seen.found) << "a bright one is";
  EXPECT_FALSE(seen.dark);
  EXPECT_NEAR(lit.asked_of().x_px, kInLight.x_px, 1.5);
  EXPECT_NEAR(lit.asked_of().radius_px, kInLight.radius_px, 1.5);
}

TEST(IntegratedTracker, ABallThatIsFollowedOutOfAShadedPlaceHasToTurnBright) {
  const test::QuarterMask mask;
  const AllPlaces lit(false);
  const AllPlaces shaded(true);
  Bench bench;
  ASSERT_TRUE(bench.look(with_ball(kInShade, kShade), mask.view(), &shaded).found);
  EXPECT_FALSE(bench.look(with_ball(kInShade, kShade), mask.view(), &lit).found);
}

/// A ball that lies in shade for so many images, where it is as bright as that.
void follow_in_shade(double factor, int images, Bench& bench, const AllPlaces& shaded = AllPlaces(true)) {
  const test::QuarterMask mask;
  for (int i = 0; i < images; ++i) {
    const Circle at{kInShade.x_px + 0.2 * i, kInShade.y_px, kInShade.radius_px};
    ASSERT_TRUE(bench.look(with_ball(at, factor), mask.view(), &shaded).found) << i;
  }
}

/// Looks at a room without the ball until it is lost.
void lose_the_ball(Bench& bench) {
  const test::QuarterMask mask;
  const AllPlaces shaded(true);
  for (int i = 0; i < 6; ++i) EXPECT_FALSE(bench.look(test::ball_room(kShade), mask.view(), &shaded).found);
}

// By daylight a ball in the lamp's shade is nearly as bright as elsewhere: a brown one there is no orange one.
TEST(IntegratedTracker, WhereShadeIsSeenToBeBrightADarkBallInItIsAnother) {
  const test::QuarterMask mask;
  const AllPlaces shaded(true);
  Bench without;
  EXPECT_TRUE(without.look(with_ball(kInShade, kShade), mask.view(), &shaded).found) << "this test could not fail";
  Bench bench;
  follow_in_shade(0.9, 15, bench);
  lose_the_ball(bench);
  EXPECT_FALSE(bench.look(with_ball(kInShade, kShade), mask.view(), &shaded).found);
  EXPECT_TRUE(bench.look(with_ball(kInShade, 0.9), mask.view(), &shaded).found) << "the ball itself is";
  lose_the_ball(bench);
  EXPECT_FALSE(bench.look(with_ball(kInShade, kShade), mask.view()).found) << "by the mask alone";
  EXPECT_TRUE(bench.look(with_ball(kInShade, kShade), {}).found) << "where no shade is known";
}

/// Whether a dark ball is found after the ball was followed in shade, as bright as `factor`, and lost.
bool is_dark_ball_found_after(double factor, const AllPlaces& places) {
  const test::QuarterMask mask;
  Bench bench;
  follow_in_shade(factor, 15, bench, places);
  lose_the_ball(bench);
  return bench.look(with_ball(kInShade, kShade), mask.view(), &places).found;
}

TEST(IntegratedTracker, WhatSurelyLiesInShadeAloneSaysHowDarkShadeIs) {
  EXPECT_FALSE(is_dark_ball_found_after(0.9, AllPlaces(true)));
  EXPECT_TRUE(is_dark_ball_found_after(0.9, AllPlaces(true, false))) << "it may have lain in the light";
  EXPECT_TRUE(is_dark_ball_found_after(kShade, AllPlaces(true))) << "the ball itself was as dark";
}

// What was seen of shade says nothing of a ball that has not been out of view: the lamp may have gone out.
TEST(IntegratedTracker, AFollowedBallMayBecomeDarkerThanItEverWas) {
  const test::QuarterMask mask;
  const AllPlaces shaded(true);
  Bench bench;
  follow_in_shade(0.9, 15, bench);
  EXPECT_TRUE(bench.look(with_ball(kInShade, kShade), mask.view(), &shaded).found);
}

TEST(IntegratedTracker, TheMaskSavesWork) {
  const test::QuarterMask mask;
  Bench with_mask;
  Bench without;
  const auto less = with_mask.look(with_ball(kInLight, 1.0), mask.view());
  const auto more = without.look(with_ball(kInLight, 1.0), {});
  EXPECT_EQ(less.bright_windows, more.bright_windows);
  EXPECT_EQ(less.bright_examined, more.bright_examined);
  EXPECT_LT(less.dark_windows, more.dark_windows / 2);
  const std::vector<std::uint8_t> lit(12, 0);
  Bench all_lit;
  const auto least = all_lit.look(with_ball(kInLight, 1.0), {lit.data(), 4, 3, 4});
  EXPECT_TRUE(least.mask_used);
  EXPECT_EQ(least.dark_windows, 0);
  EXPECT_TRUE(least.found);
}

TEST(IntegratedTrackerFault, AMaskThatCannotBeUsedIsNone) {
  const std::vector<std::uint8_t> cells(400 * 300, 0);
  Bench bench;
  EXPECT_FALSE(bench.look(with_ball(kInLight, 1.0), {cells.data(), 400, 300, 400}).mask_used) << "finer than the image";
  EXPECT_FALSE(bench.look(with_ball(kInLight, 1.0), {cells.data(), 40, 30, 20}).mask_used) << "rows that overlap";
  EXPECT_FALSE(bench.look(with_ball(kInLight, 1.0), {nullptr, 40, 30, 40}).mask_used);
}

// Out of the light into the shade: in between half of the ball is bright, half of it dark.
TEST(IntegratedTracker, FollowsTheBallIntoTheShade) {
  const test::QuarterMask mask;
  Bench bench;
  for (int i = 0; i < 50; ++i) {
    const Circle circle{100.0 + 3.0 * i, 185.0, 15.0};
    auto painting = with_ball(circle, 1.0);
    auto shaded = with_ball(circle, kShade);
    for (int y = 120; y < test::kBallHeight_px; ++y) {
      for (int x = test::kBallWidth_px / 2; x < test::kBallWidth_px; ++x) painting.at(x, y) = shaded.at(x, y);
    }
    const auto seen = bench.look(painting, mask.view());
    ASSERT_TRUE(seen.found) << i;
    EXPECT_GT(intersection_over_union(seen.box, test::around(circle)), 0.75) << i;
  }
}

TEST(IntegratedTracker, LosesWhatIsGoneAndFindsItElsewhere) {
  const test::QuarterMask mask;
  Bench bench;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(bench.look(with_ball(kInLight, 1.0), mask.view()).found);
  for (int i = 0; i < 6; ++i) EXPECT_FALSE(bench.look(test::ball_room(kShade), mask.view()).found) << i;
  const auto seen = bench.look(with_ball({250.0, 60.0, 22.0}, 1.0), mask.view());
  ASSERT_TRUE(seen.found);
  EXPECT_NEAR(seen.circle.radius_px, 22.0, 1.5);
}

TEST(IntegratedTracker, AJumpIsFollowedAtOnce) {
  const test::QuarterMask mask;
  Bench bench;
  int found = 0;
  for (int i = 0; i < 12; ++i) {
    const Circle circle = i % 2 == 0 ? kInLight : Circle{250.0, 60.0, 14.0};
    const auto seen = bench.look(with_ball(circle, 0.9), mask.view());
    if (!seen.found) continue;
    ++found;
    EXPECT_GT(intersection_over_union(seen.box, test::around(circle)), 0.75) << i;
  }
  EXPECT_GE(found, 10);
}

TEST(IntegratedTracker, ASquareOrAStripeInItsColourIsNotTheBall) {
  const test::QuarterMask mask;
  Bench bench;
  for (int i = 0; i < 4; ++i) {
    auto painting = test::ball_room(kShade);
    painting.fill({60.0 + 5 * i, 40, 34, 34}, test::kOrange);
    painting.fill({0, 150, 120, 26}, test::kOrange);
    EXPECT_FALSE(bench.look(painting, mask.view()).found) << i;
  }
}

TEST(IntegratedTracker, ABudgetEndsTheSearchAndIsSaid) {
  class Budget final : public WorkBudget {
   public:
    bool grant() override { return left_-- > 0; }

   private:
    int left_ = 3;
  } budget;
  IntegratedTracker tight = tracker();
  const test::QuarterMask mask;
  auto painting = with_ball(kInLight, 1.0);
  EXPECT_FALSE(tight.track(painting.photograph(1.5, 3), mask.view(), budget).exact);
}

// In images that are alike the search that is spread over them finds what it finds at once, however few units an image has.
TEST(IntegratedTracker, WithFewUnitsAnImageItFindsTheSameBallLater) {
  const test::QuarterMask mask;
  for (const Circle& circle : {kInLight, kInShade}) {
    auto painting = with_ball(circle, circle.x_px == kInShade.x_px ? kShade : 1.0);
    const ImageView image = painting.photograph(1.5, 3);
    const int units = circle.x_px == kInShade.x_px ? 150 : 4;
    UnlimitedBudget all;
    IntegratedTracker at_once = tracker();
    const auto expected = at_once.track(image, mask.view(), all);
    ASSERT_TRUE(expected.found);
    IntegratedTracker spread = tracker();
    BallSighting seen;
    int images = 0;
    while (!seen.found && ++images < 3000) {
      CountedBudget budget(units);
      seen = spread.track(image, mask.view(), budget);
      EXPECT_TRUE(seen.found || !seen.exact) << images;
    }
    EXPECT_GT(images, 1) << "this test could not fail";
    ASSERT_TRUE(seen.found);
    EXPECT_EQ(seen.circle.x_px, expected.circle.x_px);
    EXPECT_EQ(seen.circle.radius_px, expected.circle.radius_px);
    EXPECT_EQ(seen.divergence, expected.divergence);
    EXPECT_EQ(seen.dark, expected.dark);
  }
}

TEST(IntegratedTracker, WithFewUnitsAnImageItFindsABallThatMoves) {
  const test::QuarterMask mask;
  IntegratedTracker spread = tracker();
  int first = -1;
  for (int i = 0; i < 40; ++i) {
    const Circle moved{40.0 + 2.0 * i, kInLight.y_px, kInLight.radius_px};
    auto painting = with_ball(moved, 1.0);
    CountedBudget budget(300);
    const auto seen = spread.track(painting.photograph(1.5, 200 + static_cast<std::uint32_t>(i)), mask.view(), budget);
    if (!seen.found) {
      EXPECT_EQ(first, -1) << "lost in image " << i;
      continue;
    }
    if (first < 0) first = i;
    EXPECT_GT(intersection_over_union(seen.box, test::around(moved)), 0.75) << i;
  }
  EXPECT_GT(first, 0) << "this test could not fail";
  EXPECT_LT(first, 12);
}

/// In how many of these images with one ball that is followed the tracker searches.
int searches(double factor, int images) {
  class Counter final : public WorkBudget {
   public:
    bool grant() override { return ++asked > 0; }
    int asked = 0;
  };
  const test::QuarterMask mask;
  IntegratedTracker one = tracker();
  int count = 0;
  for (int i = 0; i < images; ++i) {
    auto painting = with_ball({kInLight.x_px + 3.0 * i, kInLight.y_px, kInLight.radius_px}, factor);
    Counter budget;
    const auto seen = one.track(painting.photograph(1.5, 300 + static_cast<std::uint32_t>(i)), mask.view(), budget);
    EXPECT_TRUE(seen.found) << factor << ", " << i;
    count += budget.asked > 0 ? 1 : 0;
  }
  return count;
}

TEST(IntegratedTracker, ABallThatIsFollowedSurelyIsNotSearchedFor) {
  EXPECT_EQ(searches(0.8, 16), 1);
}

TEST(IntegratedTracker, WhatIsLessAlikeIsFollowedAndAnotherLookedForNowAndThen) {
  EXPECT_GT(searches(1.0, 16), 2);
  EXPECT_LT(searches(1.0, 16), 6);
}

// What shade makes of the ball's colour is the colour of the floor on which it lies in the light.
TEST(IntegratedTracker, ABrightBallOnAFloorOfItsDarkColoursDoesNotRunIntoIt) {
  Bench bench;
  for (int i = 0; i < 6; ++i) {
    const Circle moved{kInLight.x_px + 4.0 * i, 150.0, kInLight.radius_px};
    auto painting = test::ball_room();
    painting.fill({0.0, 110.0, 320.0, 130.0}, color::lit(test::kOrange, {0.3, 0.3, 0.3}));
    test::paint_ball(painting, moved, 0.8);
    const auto seen = bench.look(painting, {});
    ASSERT_TRUE(seen.found) << i;
    EXPECT_GT(intersection_over_union(seen.box, test::around(moved)), 0.85) << i;
  }
}

// A yellow ball is alike enough to be found as long as there is none that is more so.
TEST(IntegratedTracker, OfTwoBallsTheOneMoreAlikeIsFollowedInTheEnd) {
  const test::QuarterMask mask;
  constexpr Circle kOther{250.0, 60.0, 16.0};
  Bench bench;
  const auto look = [&](bool with_orange) {
    auto painting = test::ball_room(kShade);
    test::paint_ball(painting, kOther, 0.8, {0.92, 0.62, 0.10});
    if (with_orange) test::paint_ball(painting, kInLight, 0.8);
    return bench.look(painting, mask.view());
  };
  int taken = 0;
  for (int i = 0; i < 5; ++i) taken += look(false).found ? 1 : 0;
  EXPECT_GT(taken, 2) << "this test could not fail";
  BallSighting seen;
  for (int i = 0; i < 12; ++i) seen = look(true);
  ASSERT_TRUE(seen.found);
  EXPECT_GT(intersection_over_union(seen.box, test::around(kInLight)), 0.85);
}

// Something large of the ball's colours has many windows that are like it.
TEST(IntegratedTracker, ALargeSurfaceOfItsColoursDoesNotUseUpTheLooks) {
  const test::QuarterMask mask;
  Bench bench;
  auto painting = with_ball(kInLight, 0.9);
  for (int row = 0; row < 24; ++row) {
    const double light = 0.8 * (0.6 + 0.4 * (row % 10) / 9.0);  // from the ball's top to its bottom, again and again
    painting.fill({220.0, 30.0 + row, 60.0, 1.0}, color::lit(test::kOrange, {light, light, light}));
  }
  const auto seen = bench.look(painting, mask.view());
  ASSERT_TRUE(seen.found);
  EXPECT_GT(intersection_over_union(seen.box, test::around(kInLight)), 0.85);
}

TEST(IntegratedTrackerFault, ImagesThatCannotBeSearchedGiveNothing) {
  IntegratedTracker one = tracker();
  UnlimitedBudget budget;
  const std::vector<std::uint8_t> grey(640 * 480, 100);
  EXPECT_FALSE(one.track({grey.data(), 320, 240, 320, PixelFormat::kGrey8}, {}, budget).found);
  EXPECT_FALSE(one.track({}, {}, budget).found);
  EXPECT_FALSE(one.track({grey.data(), 640, 240, 1280, PixelFormat::kYuyv}, {}, budget).found) << "too large";
}

TEST(IntegratedTrackerFault, SizesThatCannotBe) {
  IntegratedParameters parameters;
  parameters.ball.min_distance_m = 3.0;
  parameters.ball.max_distance_m = 2.0;
  EXPECT_FALSE(IntegratedTracker::create(test::ball_model(), parameters, 320, 240, kFocal_px).has_value());
}

TEST(IntegratedTrackerAlloc, TrackTakesNoMemory) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "this build does not count allocations";
  IntegratedTracker one = tracker();
  UnlimitedBudget budget;
  const test::QuarterMask mask;
  auto light = with_ball(kInLight, 1.0);
  auto shade = with_ball(kInShade, kShade);
  auto nothing = test::ball_room(kShade);
  const ImageView a = light.photograph(1.5, 3);
  const ImageView b = shade.photograph(1.5, 4);
  const ImageView c = nothing.photograph(1.5, 5);
  for (const ImageView& image : {a, b, c}) one.track(image, {}, budget);
  const test::AllocationGuard guard;
  for (const ImageView& image : {a, b, c, c, c, c, c, a}) {
    one.track(image, mask.view(), budget);
    one.track(image, {}, budget);
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::color
