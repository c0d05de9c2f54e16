#include "pipeline/color/track/tracker.h"
#include "pipeline/color/track/object_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "pipeline/color/search/exhaustive_search.h"
#include "tests/color/scene.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/counted_budget.h"

namespace cgsr::color {
namespace {

constexpr int kWidth_px = 320;
constexpr int kHeight_px = 240;
constexpr Light kLearnedLight{0.8, 0.8, 0.8};
constexpr Box kFirst{130, 90, 40, 52};
constexpr int kStrongBlur_px = 45;

Box moved(double x, double y, double factor = 1.0) {
  return {x, y, kFirst.width * factor, kFirst.height * factor};
}

struct ThingColors {
  imaging::Rgb top, middle, bottom, disc;
};
constexpr ThingColors kThing{{0.85, 0.15, 0.12}, {0.92, 0.9, 0.88}, {0.12, 0.2, 0.8}, {0.95, 0.8, 0.1}};

/// A red, white and blue thing with a pattern, at any place and size, before a wall with a floor, all under one light.
test::Painting room(const Box* object, const Light& light = kLearnedLight, const ThingColors& colors = kThing) {
  test::Painting painting(kWidth_px, kHeight_px);
  painting.paint([&](int x, int y) {
    const double grain = 0.03 * std::sin(0.31 * x + 0.11 * y) + 0.02 * std::sin(0.07 * x - 0.43 * y);
    imaging::Rgb color =
        y < 170 ? imaging::Rgb{0.55 + grain, 0.58 + grain, 0.45} : imaging::Rgb{0.40, 0.33 + grain, 0.2};
    if (object != nullptr && x >= object->x && x < object->x + object->width && y >= object->y &&
        y < object->y + object->height) {
      const double u = (x + 0.5 - object->x) / object->width, v = (y + 0.5 - object->y) / object->height;
      color = v < 0.35 ? colors.top : v < 0.6 ? colors.middle : colors.bottom;
      const bool disc = (u - 0.4) * (u - 0.4) + (v - 0.5) * (v - 0.5) < 0.03;
      const bool bar = u > 0.7 && u < 0.85 && v > 0.1 && v < 0.9;
      if (disc) color = colors.disc;
      if (bar) color = {0.1, 0.1, 0.12};
    }
    return lit(color, light);
  });
  return painting;
}

/// Something of the same shape in other colours, but for its lower third: as two people wear the same trousers.
test::Painting room_with_another(const Box& object) {
  return room(&object, kLearnedLight, {{0.1, 0.1, 0.1}, {0.3, 0.3, 0.1}, kThing.bottom, {0.2, 0.2, 0.2}});
}

/// As a fast move to the side shows it: the mean of `length_px` pixels of a row.
test::Painting blurred(test::Painting painting, int length_px) {
  test::Painting sharp = painting;
  painting.paint([&](int x, int y) {
    imaging::Rgb sum{0.0, 0.0, 0.0};
    for (int i = 0; i < length_px; ++i) {
      const auto pixel = sharp.at(std::clamp(x + i - length_px / 2, 0, kWidth_px - 1), y);
      sum = {sum.r + pixel.r / length_px, sum.g + pixel.g / length_px, sum.b + pixel.b / length_px};
    }
    return sum;
  });
  return painting;
}

/// A tracker with what it needs around it, and images with the noise of a camera.
class Bench {
 public:
  explicit Bench(const TrackParameters& parameters = {}) : reduced_(kWidth_px, kHeight_px) {
    auto painting = room(&kFirst);
    const Sample sample{painting.photograph(1.0, 7), kFirst};
    model_ = learn({&sample, 1}, {}).value().model;
    tracker_.emplace(Tracker::create(model_, parameters, kWidth_px, kHeight_px).value());
    search_.emplace(ObjectSearch::create(model_, parameters, kWidth_px, kHeight_px).value());
  }
  TrackedObject look(test::Painting painting) { return look(painting.photograph(1.5, ++seed_)); }
  TrackedObject look(const ImageView& image) {
    UnlimitedBudget budget;
    return look(image, budget);
  }
  TrackedObject look(const ImageView& image, WorkBudget& budget) {
    const imaging::ReducedImage& reduced = reduce(image);
    const SearchResult matches = search_->search(reduced, tracker_->search_size(), budget);
    return tracker_->track(image, reduced, matches, budget);
  }
  /// As in an image that was not searched.
  TrackedObject look_nearby(test::Painting painting) {
    UnlimitedBudget budget;
    return look_nearby(std::move(painting), budget);
  }
  TrackedObject look_nearby(test::Painting painting, WorkBudget& budget) {
    const ImageView image = painting.photograph(1.5, ++seed_);
    return tracker_->track(image, reduce(image), {}, budget);
  }
  const imaging::ReducedImage& reduce(const ImageView& image) {
    const int factor = imaging::reduction_for(image.width_px, image.height_px, search_->object_shorter_side_px());
    EXPECT_TRUE(imaging::reduce(image, factor, search_->labels(), reduced_));
    return reduced_;
  }
  TrackedObject see(const Box& object, const Light& light = kLearnedLight) { return look(room(&object, light)); }
  TrackedObject see_nothing() { return look(room(nullptr)); }
  [[nodiscard]] const ColorModel& model() const { return model_; }
  Tracker& tracker() { return *tracker_; }

 private:
  ColorModel model_;
  imaging::ReducedImage reduced_;
  std::optional<Tracker> tracker_;
  std::optional<ObjectSearch> search_;
  std::uint32_t seed_ = 100;
};

TEST(TrackerProperty, FindsTheObjectWhereverItIsAtFirstSight) {
  std::mt19937 random(111);
  for (int trial = 0; trial < 12; ++trial) {
    Bench bench;
    const Box place = moved(5.0 + random() % 270, 5.0 + random() % 180);
    const auto found = bench.see(place);
    ASSERT_TRUE(found.found) << place.x << ',' << place.y;
    EXPECT_GT(intersection_over_union(found.box, place), 0.7) << place.x << ',' << place.y;
    EXPECT_LT(found.divergence, 0.3);
  }
}

TEST(Tracker, FollowsTheObjectAcrossTheImage) {
  Bench bench;
  for (int i = 0; i < 40; ++i) {
    const Box place = moved(20 + 6 * i, 90 + 40 * std::sin(0.2 * i));
    const auto found = bench.see(place);
    ASSERT_TRUE(found.found) << i;
    EXPECT_GT(intersection_over_union(found.box, place), 0.7) << i;
  }
}

TEST(Tracker, StartsWhereItIsToldTheObjectIs) {
  Bench bench;
  auto painting = room(&kFirst);
  const ImageView image = painting.photograph(1.0, 7);
  bench.tracker().place(image, bench.reduce(image), kFirst);
  const auto found = bench.see(moved(kFirst.x + 5, kFirst.y - 3));
  ASSERT_TRUE(found.found);
  EXPECT_GT(intersection_over_union(found.box, moved(kFirst.x + 5, kFirst.y - 3)), 0.8);
}

// Scenes that have nothing to do with one another: a film's cut, or a robot that turned fast. What was is no cage.
TEST(Tracker, FollowsAJumpToTheOtherEndOfTheImageAtOnce) {
  Bench bench;
  for (int i = 0; i < 30; ++i) {
    const Box place = i % 3 == 2 ? moved(250, 150) : i % 3 == 1 ? moved(20, 20) : moved(140, 95);
    const auto found = bench.see(place);
    ASSERT_TRUE(found.found) << i;
    EXPECT_GT(intersection_over_union(found.box, place), 0.6) << i;
  }
}

TEST(Tracker, SomethingElseInItsPlaceIsNotTheObject) {
  Bench bench;
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(bench.see(kFirst).found) << i;
  TrackedObject found;
  for (int i = 0; i < 15; ++i) found = bench.look(room_with_another(kFirst));
  EXPECT_FALSE(found.found);
  for (int i = 0; i < 3; ++i) found = bench.see(moved(40, 30));
  ASSERT_TRUE(found.found) << "and what it saw instead was not learned";
  EXPECT_GT(intersection_over_union(found.box, moved(40, 30)), 0.5);
}

TEST(Tracker, SomethingElseIsNotTakenForItAtFirstSight) {
  for (const Box& place : {kFirst, moved(20, 30), moved(230, 100)}) {
    Bench bench;
    for (int i = 0; i < 6; ++i) EXPECT_FALSE(bench.look(room_with_another(place)).found) << place.x << ' ' << i;
  }
}

// A fast move leaves little of its shape, but all of its colours.
TEST(Tracker, RecognisesABlurredObjectElsewhere) {
  Bench bench;
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(bench.see(moved(60 + i, 90)).found) << i;
  int found_images = 0;
  for (int i = 0; i < 4; ++i) {
    const Box place = moved(220 + 8 * i, 60);
    const auto found = bench.look(blurred(room(&place), 5));
    if (found.found && intersection_over_union(found.box, place) > 0.5) ++found_images;
  }
  EXPECT_GE(found_images, 3);
}

// In doubt it is followed without being reported, so that it is there when it looks like itself again. No search helps here.
TEST(Tracker, FollowsWhatMayBeTheLostObjectWithoutReportingIt) {
  TrackParameters parameters;
  parameters.doubt.places_while_lost = 0;
  Bench bench(parameters);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(bench.see(moved(60, 90)).found) << i;
  int reported = 0;
  for (int i = 0; i < 40; ++i) {
    const Box place = moved(60 + 4 * i, 90);
    if (bench.look_nearby(blurred(room(&place), kStrongBlur_px)).found) ++reported;
  }
  EXPECT_LT(reported, 10);
  const Box place = moved(220, 90);
  TrackedObject found;
  for (int i = 0; i < 4; ++i) found = bench.look_nearby(room(&place));
  ASSERT_TRUE(found.found);
  EXPECT_GT(intersection_over_union(found.box, place), 0.6);
}

TEST(Tracker, LooksAroundThePlaceWhereItWasLost) {
  for (const Box& place : {moved(kFirst.x - 60, kFirst.y), moved(kFirst.x + 65, kFirst.y + 70)}) {
    TrackParameters parameters;
    Bench bench(parameters);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(bench.see(kFirst).found) << i;
    for (int i = 0; i < 8; ++i) ASSERT_FALSE(bench.look_nearby(room(nullptr)).found) << i;
    TrackedObject found;
    for (int i = 0; i < 7 && !found.found; ++i) found = bench.look_nearby(room(&place));
    ASSERT_TRUE(found.found) << place.x;
    EXPECT_GT(intersection_over_union(found.box, place), 0.6) << place.x;
  }
}

// Its recent colours tell where to look in the whole image, though no search does.
TEST(Tracker, LooksWhereItsColorsStandOut) {
  Bench bench;
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(bench.see(moved(20, 20)).found) << i;
  for (int i = 0; i < 12; ++i) ASSERT_FALSE(bench.look_nearby(room(nullptr)).found) << i;
  const Box place = moved(250, 160);
  TrackedObject found;
  for (int i = 0; i < 4 && !found.found; ++i) found = bench.look_nearby(room(&place));
  ASSERT_TRUE(found.found);
  EXPECT_GT(intersection_over_union(found.box, place), 0.6);
}

// With work for one place in each image all 25 around have their turn, on either side: every second image is theirs.
TEST(Tracker, LooksAtEveryPlaceAroundWithLittleWork) {
  for (const Box& place : {moved(kFirst.x - 75, kFirst.y - 90), moved(kFirst.x + 85, kFirst.y - 20),
                           moved(kFirst.x + 42, kFirst.y), moved(kFirst.x - 75, kFirst.y + 20)}) {
    Bench bench;
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(bench.see(kFirst).found) << i;
    for (int i = 0; i < 8; ++i) ASSERT_FALSE(bench.look_nearby(room(nullptr)).found) << i;
    TrackedObject found;
    for (int i = 0; i < 50 && !found.found; ++i) {
      CountedBudget budget(2);  // what may be it, and one place
      found = bench.look_nearby(room(&place), budget);
    }
    ASSERT_TRUE(found.found) << place.x << ',' << place.y;
    EXPECT_GT(intersection_over_union(found.box, place), 0.5) << place.x << ',' << place.y;
  }
}

// Having left the image, it comes back nearer or farther.
TEST(TrackerProperty, FindsItAgainInAnotherSize) {
  for (const double factor : {0.8, 0.9, 1.0, 1.15, 1.3}) {
    Bench bench;
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(bench.see(kFirst).found) << i;
    for (int i = 0; i < 8; ++i) bench.see_nothing();
    const Box place = moved(30, 40, factor);
    TrackedObject found;
    for (int i = 0; i < 6; ++i) found = bench.see(place);
    ASSERT_TRUE(found.found) << factor;
    EXPECT_GT(intersection_over_union(found.box, place), 0.6) << factor;
  }
}

TEST(Tracker, DoesNotFindWhatIsNotThere) {
  Bench bench;
  for (int i = 0; i < 15; ++i) EXPECT_FALSE(bench.see_nothing().found) << i;
}

TEST(TrackerProperty, FindsItAgainAnywhereAfterALoss) {
  std::mt19937 random(112);
  Bench bench;
  Box place = kFirst;
  for (int loss = 0; loss < 6; ++loss) {
    for (int i = 0; i < 12; ++i) ASSERT_TRUE(bench.see(place).found) << loss << ' ' << i;
    for (int i = 0; i < 8; ++i) ASSERT_FALSE(bench.see_nothing().found) << loss << ' ' << i;

    place = moved(5.0 + random() % 270, 5.0 + random() % 180);

    TrackedObject found;
    for (int i = 0; i < 3; ++i) found = bench.see(place);
    ASSERT_TRUE(found.found) << loss << ": " << place.x << ',' << place.y;
    EXPECT_GT(intersection_over_union(found.box, place), 0.6) << loss << ": " << place.x << ',' << place.y;
  }
}

// The whole room under another light than the learned one: found at first sight, and the light named.
TEST(TrackerProperty, FindsItUnderEveryLightOfTheGridAndNamesTheLight) {
  const auto lights = light_grid({});
  for (const Light& light : lights) {
    Bench bench;
    const Box place = moved(60, 70);
    const auto found = bench.see(place, light);
    const auto words = testing::PrintToString(std::array{light.r, light.g, light.b});
    ASSERT_TRUE(found.found) << words;
    EXPECT_GT(intersection_over_union(found.box, place), 0.6) << words;
    EXPECT_NEAR(found.exact_light.r / light.r, 1.0, 0.06) << words;
    EXPECT_NEAR(found.exact_light.g / light.g, 1.0, 0.06) << words;
    EXPECT_NEAR(found.exact_light.b / light.b, 1.0, 0.06) << words;
    EXPECT_NEAR(found.light.r, light.r, 1e-9) << words;
    EXPECT_NEAR(found.light.g, light.g, 1e-9) << words;
    EXPECT_NEAR(found.light.b, light.b, 1e-9) << words;
  }
}

TEST(Tracker, ReportsTheNearestLightOfTheGrid) {
  Bench bench;
  const auto found = bench.see(moved(60, 70), {0.94, 0.76, 0.65});
  ASSERT_TRUE(found.found);
  EXPECT_NEAR(found.light.r, 1.0, 1e-9);
  EXPECT_NEAR(found.light.g, 0.8, 1e-9);
  EXPECT_NEAR(found.light.b, 0.6, 1e-9);
}

TEST(Tracker, KeepsItsBoxWhenTheLightIsSwitched) {
  Bench bench;
  for (int i = 0; i < 30; ++i) {
    const Light light = i / 10 % 2 == 0 ? kLearnedLight : Light{1.0, 0.8, 0.6};
    const Box place = moved(60 + 3 * i, 80);
    const auto found = bench.see(place, light);
    ASSERT_TRUE(found.found) << i;
    EXPECT_GT(intersection_over_union(found.box, place), 0.6) << i;
  }
}

TEST(TrackerProperty, KeepsItsBoxWhileTheObjectGrowsOrShrinks) {
  for (const double end : {1.3, 0.75}) {
    Bench bench;
    for (int i = 0; i <= 40; ++i) {
      const double factor = std::pow(end, i / 40.0);
      const Box place = moved(150 - 0.5 * kFirst.width * factor, 110 - 0.5 * kFirst.height * factor, factor);
      const auto found = bench.see(place);
      ASSERT_TRUE(found.found) << i;
      EXPECT_GT(intersection_over_union(found.box, place), 0.7) << i << " to " << end;
    }
  }
}

TEST(Tracker, TheBoxStaysInsideTheImageWhenTheObjectLeavesIt) {
  Bench bench;
  const Box image{0, 0, kWidth_px, kHeight_px};
  for (int i = 0; i < 30; ++i) {
    const auto found = bench.see(moved(240 + 3 * i, 90));
    if (!found.found) continue;
    EXPECT_EQ(intersection(found.box, image), found.box) << i;
  }
}

// Mode plain is Alg. 3.2 and nothing else: the best window of the exhaustive search, image by image.
TEST(TrackerProperty, PlainIsTheBestMatchOfTheExhaustiveSearch) {
  TrackParameters parameters;
  parameters.mode = TrackMode::kPlain;
  auto settings = parameters.search;
  settings.weights = BinWeights::kPlain;
  settings.sizes = 1;
  Bench bench(parameters);
  const ExhaustiveSearch slow(bench.model(), settings);
  std::mt19937 random(113);
  std::uniform_real_distribution<double> level(0.6, 1.0);
  int found_images = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const Box place = moved(random() % 280, random() % 180);
    auto painting = trial % 4 == 3 ? room(nullptr) : room(&place, {level(random), level(random), level(random)});
    const ImageView image = painting.photograph(2.0, random());
    const auto found = bench.look(image);

    SearchRequest request;
    request.width_px = bench.model().width_px;
    request.height_px = bench.model().height_px;
    request.max_divergence = parameters.max_divergence;
    const auto expected = slow.search(bench.reduce(image), request).value();

    ASSERT_EQ(found.found, expected.count > 0) << trial;
    if (!found.found) continue;
    ++found_images;
    EXPECT_EQ(found.box, expected.matches[0].box) << trial;
    EXPECT_EQ(found.divergence, expected.matches[0].divergence) << trial;
    const Light& light = bench.model().lights[static_cast<std::size_t>(expected.matches[0].light)];
    EXPECT_EQ(found.light.r, light.r);
    EXPECT_EQ(found.light.g, light.g);
    EXPECT_EQ(found.light.b, light.b);
  }
  EXPECT_GE(found_images, 5);
}

TEST(TrackerFault, AModelWithoutAPictureIsRefusedInFullMode) {
  auto model = Bench().model();
  model.samples.clear();
  EXPECT_FALSE(Tracker::create(model, {}, kWidth_px, kHeight_px));
  TrackParameters plain;
  plain.mode = TrackMode::kPlain;
  EXPECT_TRUE(Tracker::create(model, plain, kWidth_px, kHeight_px));
}

TEST(TrackerFault, WithoutABudgetItStillFollowsWhatItSaw) {
  Bench bench;
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(bench.see(kFirst).found);
  CountedBudget none(0);
  for (int i = 1; i <= 5; ++i) {
    const Box place = moved(kFirst.x + 4 * i, kFirst.y);
    auto painting = room(&place);
    const ImageView image = painting.photograph(1.0, 9);
    const auto found = bench.look(image, none);
    ASSERT_TRUE(found.found) << i;
    EXPECT_GT(intersection_over_union(found.box, place), 0.6) << i;
  }
}

TEST(TrackerAlloc, NothingInAnyState) {
  if (!cgsr::test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  Bench bench;
  const Box near = moved(kFirst.x + 6, kFirst.y), far = moved(20, 20);
  auto at_first = room(&kFirst), at_near = room(&near, {1.0, 0.8, 0.6}), nowhere = room(nullptr), at_far = room(&far);
  const ImageView first = at_first.photograph(), next = at_near.photograph(), empty = nowhere.photograph(),
                  again = at_far.photograph();
  int sights = 0, misses = 0;
  bench.look(empty);
  const cgsr::test::AllocationGuard guard;
  for (const ImageView* image : {&first, &next, &empty, &again}) {
    for (int i = 0; i < 12; ++i) ++(bench.look(*image).found ? sights : misses);
  }
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_GT(sights, 20);
  EXPECT_GT(misses, 5);
}

}  // namespace
}  // namespace cgsr::color
