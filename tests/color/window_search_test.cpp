#include "pipeline/color/search/window_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "pipeline/color/search/exhaustive_search.h"
#include "tests/color/scene.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/counted_budget.h"

namespace cgsr::color {

bool operator==(const Match& a, const Match& b) {
  return a.box == b.box && a.divergence == b.divergence && a.light == b.light && a.size == b.size;
}

void PrintTo(const Match& m, std::ostream* out) {
  *out << m.box.x << ',' << m.box.y << ' ' << m.box.width << 'x' << m.box.height << " divergence " << m.divergence
       << " light " << m.light;
}

namespace {

void expect_same(const SearchResult& fast, const SearchResult& slow, int trial) {
  ASSERT_EQ(fast.count, slow.count) << trial;
  EXPECT_TRUE(fast.exact) << trial;
  EXPECT_EQ(fast.windows, slow.windows) << trial;
  for (std::size_t i = 0; i < static_cast<std::size_t>(fast.count); ++i) {
    ASSERT_EQ(fast.matches[i], slow.matches[i]) << "trial " << trial << " match " << i;
  }
}

// An image of random patches, with pieces of the sample pasted in under other lights.
test::Painting scene_with(test::Painting& sample, const Box& object, int width, int height, std::mt19937& random) {
  auto scene = test::clutter(width, height, random, static_cast<int>(random() % 20));
  std::uniform_real_distribution<double> level(0.5, 1.1);
  for (int copies = static_cast<int>(random() % 3); copies > 0; --copies) {
    const Light light{level(random), level(random), level(random)};
    const int left = static_cast<int>(random() % static_cast<unsigned>(width)),
              top = static_cast<int>(random() % static_cast<unsigned>(height));
    for (int y = 0; y < object.height && top + y < height; ++y) {
      for (int x = 0; x < object.width && left + x < width; ++x) {
        scene.at(left + x, top + y) =
            lit(sample.at(static_cast<int>(object.x) + x, static_cast<int>(object.y) + y), light);
      }
    }
  }
  return scene;
}

SearchRequest random_request(const ColorModel& model, int width, int height, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  SearchRequest request;
  const double scale = 0.6 + unit(random);
  request.width_px = model.width_px * scale;
  request.height_px = model.height_px * scale;
  request.max_divergence = random() % 4 == 0 ? 1.0 : 0.05 + 0.6 * unit(random);
  request.candidates = random() % 2 == 0 ? 1 : 1 + static_cast<int>(random() % kMaxMatches);
  request.max_overlap = random() % 2 == 0 ? 0.0 : unit(random);
  request.max_shortfall = random() % 2 == 0 ? 1.0 : 0.3 * unit(random);
  if (random() % 3 == 0)
    request.region =
        Box{unit(random) * width / 2, unit(random) * height / 2, unit(random) * width, unit(random) * height};
  return request;
}

// The heart of it: whatever the model, image and question, the fast search answers what the exhaustive one answers, to the last bit. Both
// modes, all divergences, one match or many, regions, ties, images that are no multiple of the cell.
TEST(WindowSearchProperty, FindsWhatTheExhaustiveSearchFinds) {
  std::mt19937 random(20261121);
  int questions = 0, matches = 0;
  for (int world = 0; world < 250; ++world) {
    LearnParameters learning;
    learning.bins = {static_cast<imaging::ColorSpace>(random() % 3), 2 + static_cast<int>(random() % 7)};
    learning.lights.steps = random() % 8 == 0 ? 4 : 1 + static_cast<int>(random() % 3);
    learning.surroundings = random() % 4 == 0 ? 0.0 : 0.5;
    learning.min_distinctiveness = 0.0;
    auto sample_image = test::clutter(48, 48, random);
    const Box object{10, 10, static_cast<double>(8 + random() % 24), static_cast<double>(8 + random() % 24)};
    const Sample sample{sample_image.photograph(), object};
    const auto learned = learn({&sample, 1}, learning);
    ASSERT_TRUE(learned) << learned.error().message;

    SearchParameters parameters;
    parameters.divergence = static_cast<Divergence>(random() % 3);
    parameters.weights = static_cast<BinWeights>(random() % 2);
    parameters.sizes = 1 + static_cast<int>(random() % 5);
    parameters.max_stride_px = 1.0 + static_cast<double>(random() % 8);
    parameters.min_steps_per_side = 2 + static_cast<int>(random() % 7);
    auto fast = WindowSearch::create(learned->model, parameters, 96, 80).value();
    const ExhaustiveSearch slow(learned->model, parameters);
    ASSERT_EQ(fast.labels(), slow.labels());

    imaging::ReducedImage image(96, 80);
    for (int picture = 0; picture < 8; ++picture) {
      const int width = 24 + 2 * static_cast<int>(random() % 36), height = 24 + static_cast<int>(random() % 56);
      auto scene = scene_with(sample_image, object, width, height, random);
      const double noise = random() % 2 * 3.0;
      ASSERT_TRUE(
          imaging::reduce(scene.photograph(noise, random()), 1 + static_cast<int>(random() % 2), fast.labels(), image));
      for (int question = 0; question < 2; ++question) {
        const SearchRequest request = random_request(learned->model, width, height, random);
        const auto found = fast.search(image, request);
        const auto expected = slow.search(image, request);
        ASSERT_EQ(found.has_value(), expected.has_value()) << world;
        if (!found) {
          ASSERT_EQ(found.error(), expected.error());
          continue;
        }
        expect_same(*found, *expected, world);
        if (HasFatalFailure()) return;
        ++questions;
        matches += found->count;
      }
    }
  }
  EXPECT_GT(questions, 2500);
  EXPECT_GT(matches, questions);
}

struct FlagWorld {
  FlagWorld() : sample_image(160, 120) {
    sample_image.paint([](int x, int y) { return imaging::Rgb{0.3 + 0.001 * x, 0.5 - 0.001 * y, 0.3}; });
    test::paint_flag(sample_image, box);
    const Sample sample{sample_image.photograph(), box};
    model = learn({&sample, 1}, {}).value().model;
  }
  Box box{60, 30, 36, 48};
  test::Painting sample_image;
  ColorModel model;
};

SearchRequest request_for(const ColorModel& model) {
  SearchRequest request;
  request.width_px = model.width_px;
  request.height_px = model.height_px;
  return request;
}

TEST(WindowSearch, FindsTheObjectUnderAnotherLightAndSaysWhich) {
  FlagWorld world;
  auto search = WindowSearch::create(world.model, {}, 320, 240).value();
  test::Painting scene(320, 240);
  scene.paint([](int x, int y) { return imaging::Rgb{0.2 + 0.001 * x, 0.4 - 0.001 * y, 0.25}; });
  const Light light{1.0, 0.8, 0.6};
  test::paint_flag(scene, {204, 96, 36, 48}, light);
  imaging::ReducedImage image(320, 240);
  ASSERT_TRUE(imaging::reduce(scene.photograph(1.0), 2, search.labels(), image));

  const auto result = search.search(image, request_for(world.model));

  ASSERT_TRUE(result);
  ASSERT_EQ(result->count, 1);
  const Match& match = result->matches[0];
  EXPECT_GT(intersection(match.box, {204, 96, 36, 48}).area(), 0.7 * match.box.area());
  EXPECT_LT(match.divergence, 0.3);
  const Light& found = world.model.lights[static_cast<std::size_t>(match.light)];
  EXPECT_NEAR(found.r, light.r, 0.01);
  EXPECT_NEAR(found.g, light.g, 0.01);
  EXPECT_NEAR(found.b, light.b, 0.01);
}

TEST(WindowSearch, FindsNothingWhereThereIsNothing) {
  FlagWorld world;
  auto search = WindowSearch::create(world.model, {}, 320, 240).value();
  test::Painting scene(320, 240);
  scene.paint([](int, int) { return imaging::Rgb{0.3, 0.5, 0.3}; });
  imaging::ReducedImage image(320, 240);
  ASSERT_TRUE(imaging::reduce(scene.photograph(1.0), 2, search.labels(), image));
  const auto result = search.search(image, request_for(world.model));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->count, 0);
  EXPECT_TRUE(result->exact);
}

// However little it may do, it says so, and gets better with more; with enough it is exact.
TEST(WindowSearch, ABudgetEndsItHonestly) {
  FlagWorld world;
  auto search = WindowSearch::create(world.model, {}, 320, 240).value();
  std::mt19937 random(71);
  auto scene = test::clutter(320, 240, random, 60);
  test::paint_flag(scene, {204, 96, 36, 48}, {1.0, 0.8, 0.8});
  imaging::ReducedImage image(320, 240);
  ASSERT_TRUE(imaging::reduce(scene.photograph(2.0), 2, search.labels(), image));
  SearchRequest request = request_for(world.model);
  const auto whole = search.search(image, request).value();
  ASSERT_EQ(whole.count, 1);
  double last = 1.0;
  for (const int units : {0, 1, 2, 3, 5, 10, 1000}) {
    CountedBudget budget(units);
    request.budget = &budget;
    const auto result = search.search(image, request).value();
    if (units == 0) {
      EXPECT_EQ(result.count, 0);
      EXPECT_FALSE(result.exact);
    }
    if (units == 1000) {
      EXPECT_TRUE(result.exact);
    }
    if (result.count == 1) {
      EXPECT_LE(result.matches[0].divergence, last);
      last = result.matches[0].divergence;
    }
  }
  EXPECT_EQ(last, whole.matches[0].divergence);
}

// In pieces of any size it ends where it ends in one, to the last bit, whatever was begun and left before.
TEST(WindowSearch, InPiecesItFindsWhatItFindsAtOnce) {
  FlagWorld world;
  auto whole = WindowSearch::create(world.model, {}, 320, 240).value();
  auto pieces = WindowSearch::create(world.model, {}, 320, 240).value();
  std::mt19937 random(72);
  for (int trial = 0; trial < 12; ++trial) {
    auto scene = test::clutter(320, 240, random, 60);
    test::paint_flag(scene, {20.0 + 20 * trial, 96, 36, 48}, {1.0, 0.8, 0.8});
    imaging::ReducedImage image(320, 240);
    ASSERT_TRUE(imaging::reduce(scene.photograph(2.0), 2, whole.labels(), image));
    SearchRequest request = request_for(world.model);
    request.candidates = 3;
    const auto expected = whole.search(image, request).value();
    ASSERT_TRUE(pieces.begin(image, request));
    int images = 1;
    for (CountedBudget budget(1 + trial % 2); !pieces.advance(budget); budget = CountedBudget(1 + trial % 2)) {
      ASSERT_LT(++images, 10000);
      if (trial % 3 == 0 && images == 2) {
        ASSERT_TRUE(pieces.begin(image, request));  // anew
      }
    }
    EXPECT_GT(images, 1) << "this test could not fail";
    const SearchResult& found = pieces.result();
    EXPECT_TRUE(found.exact);
    ASSERT_EQ(found.count, expected.count) << trial;
    EXPECT_EQ(found.examined, expected.examined);
    for (std::size_t i = 0; i < static_cast<std::size_t>(found.count); ++i) {
      EXPECT_EQ(found.matches[i], expected.matches[i]) << trial;
    }
  }
}

TEST(WindowSearchFault, SaysWhatItCannotDo) {
  FlagWorld world;
  ColorModel broken = world.model;
  broken.object.pop_back();
  const auto refused = WindowSearch::create(broken, {}, 320, 240);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, ::testing::HasSubstr("object has"));
  SearchParameters none;
  none.sizes = 0;
  EXPECT_FALSE(WindowSearch::create(world.model, none, 320, 240));

  auto search = WindowSearch::create(world.model, {}, 320, 240).value();
  imaging::ReducedImage image(1280, 960);
  test::Painting large(1280, 960);
  ASSERT_TRUE(imaging::reduce(large.photograph(), 2, search.labels(), image));
  EXPECT_EQ(search.search(image, request_for(world.model)).error(), SearchFailure::kTooLarge);
  SearchRequest bad = request_for(world.model);
  bad.width_px = -1;
  EXPECT_EQ(search.search(image, bad).error(), SearchFailure::kBadRequest);
}

// Sizes, candidates and regions change from image to image: nothing is allocated, nothing faults.
TEST(WindowSearchAlloc, NothingAfterConstruction) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  FlagWorld world;
  auto search = WindowSearch::create(world.model, {}, 320, 240).value();
  std::mt19937 random(72);
  auto scene = test::clutter(320, 240, random, 60);
  test::paint_flag(scene, {204, 96, 36, 48});
  imaging::ReducedImage image(320, 240);
  ASSERT_TRUE(imaging::reduce(scene.photograph(2.0), 2, search.labels(), image));
  std::vector<SearchRequest> requests;
  constexpr int kRequests = 60;
  requests.reserve(kRequests);
  for (int i = 0; i < kRequests; ++i) requests.push_back(random_request(world.model, 320, 240, random));
  int matches = 0;
  (void)search.search(image, requests[0]);
  const test::AllocationGuard guard;
  for (const auto& request : requests) {
    const auto result = search.search(image, request);
    if (result) matches += result->count;
  }
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.page_faults(), 0U);
  EXPECT_GT(matches, 0);
}

}  // namespace
}  // namespace cgsr::color
