#include "pipeline/color/search/box_divergence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/color/scene.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::color {
namespace {

struct World {
  explicit World(std::mt19937& random, int width = 96, int height = 80, LearnParameters learning = {})
      : painting(test::clutter(width, height, random)), image(width, height) {
    learning.min_distinctiveness = 0.0;
    learning.bins.per_channel = 4 + static_cast<int>(random() % 5);
    const Sample sample{painting.photograph(2.0, random()), {20, 20, 30, 30}};
    model = learn({&sample, 1}, learning).value().model;
    labels = labels_of(model);
    factor = 1 + static_cast<int>(random() % 2);
    EXPECT_TRUE(imaging::reduce(sample.image, factor, labels.of_code, image));
  }
  test::Painting painting;
  ColorModel model;
  Labels labels;
  imaging::ReducedImage image;
  int factor = 1;
};

/// Similarity under every light, each label counted by hand, no tables. \param step  looks at every step-th pixel of either axis.
std::vector<double> similarities(const World& world, Divergence divergence, const Box& box, int step) {
  const auto bound = [&](double edge, int limit) {
    return std::clamp(static_cast<int>(std::lround(edge / world.factor)), 0, limit);
  };
  std::vector<double> counts(static_cast<std::size_t>(world.labels.count()) + 1);
  double pixels = 0;
  for (int y = bound(box.y, world.image.height_px); y < bound(box.y + box.height, world.image.height_px); y += step) {
    for (int x = bound(box.x, world.image.width_px); x < bound(box.x + box.width, world.image.width_px); x += step) {
      counts[world.image.labels[static_cast<std::size_t>(y * world.image.width_px + x)]] += 1;
      pixels += 1;
    }
  }
  std::vector<double> sums;
  for (std::size_t light = 0; light < world.model.lights.size(); ++light) {
    double sum = 0.0;
    for (std::size_t i = 0; i < world.labels.bins.size(); ++i) {
      const double q =
          1.0 * world.model.object_under(light)[static_cast<std::size_t>(world.labels.bins[i])] / kHistogramMass;
      if (pixels > 0) sum += similarity_term(divergence, counts[i + 1] / pixels, q);
    }
    sums.push_back(sum);
  }
  return sums;
}

/// The similarity that a divergence stands for.
double similarity_of(Divergence divergence, double value) {
  switch (divergence) {
    case Divergence::kJensenShannon:
      return 1.0 - value / std::log(2.0);
    case Divergence::kHellinger:
      return 1.0 - value * value;
    case Divergence::kIntersection:
      return 1.0 - value;
  }
  return 0.0;
}

// The table keeps a share as one of 128 levels of its root and rounds every term down: about a hundredth in all.
TEST(BoxDivergenceProperty, CountsLikeAHand) {
  std::mt19937 random(91);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 60; ++trial) {
    const World world(random);
    const auto kind = static_cast<Divergence>(trial % 3);
    BoxDivergence divergence(world.model, kind);
    for (int question = 0; question < 30; ++question) {
      const Box box{120 * unit(random) - 20, 100 * unit(random) - 20, 1 + 50 * unit(random), 1 + 50 * unit(random)};

      const auto answer = divergence.of(world.image, box);

      const auto expected = similarities(world, kind, box, 1);
      const double best = *std::max_element(expected.begin(), expected.end());
      ASSERT_NEAR(similarity_of(kind, answer.divergence), best, 0.02) << trial << ' ' << question;
      ASSERT_NEAR(expected[static_cast<std::size_t>(answer.light)], best, 0.02) << trial;
    }
  }
}

TEST(BoxDivergenceProperty, OfALargeBoxIsNearlyThatOfAllItsPixels) {
  std::mt19937 random(92);
  for (int trial = 0; trial < 20; ++trial) {
    World world(random, 200, 160);
    const auto kind = static_cast<Divergence>(trial % 3);
    const Box box{5, 7, 189, 150};
    const auto answer = BoxDivergence(world.model, kind).of(world.image, box);
    const auto expected = similarities(world, kind, box, 1);
    EXPECT_NEAR(similarity_of(kind, answer.divergence), *std::max_element(expected.begin(), expected.end()), 0.04);
  }
}

// What is compared with are the lights of the grid, so the sample is held to be seen under one of them: the brightest. Learning looked at
// every pixel; an image that was halved has mixed those at the edges of its patches.
TEST(BoxDivergence, OfTheLearnedBoxIsNearNothing) {
  std::mt19937 random(93);
  LearnParameters brightest;
  brightest.lights.assumed = brightest.lights.max_level;
  for (int trial = 0; trial < 20; ++trial) {
    World world(random, 96, 80, brightest);
    const auto answer = BoxDivergence(world.model, Divergence::kJensenShannon).of(world.image, {20, 20, 30, 30});
    EXPECT_LT(answer.divergence, world.factor == 1 ? 0.01 : 0.15) << trial;
  }
}

TEST(BoxDivergence, OutsideTheImageThereIsNothingAlike) {
  std::mt19937 random(94);
  World world(random);
  for (const auto kind : {Divergence::kJensenShannon, Divergence::kHellinger, Divergence::kIntersection}) {
    BoxDivergence divergence(world.model, kind);
    for (const Box& box : {Box{-50, 10, 40, 20}, Box{200, 10, 40, 20}, Box{10, 90, 40, 20}, Box{10, 10, 0, 0}}) {
      EXPECT_EQ(divergence.of(world.image, box).divergence, max_divergence(kind));
    }
  }
}

TEST(BoxDivergenceAlloc, NothingAfterConstruction) {
  if (!cgsr::test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  std::mt19937 random(95);
  World world(random);
  BoxDivergence divergence(world.model, Divergence::kJensenShannon);
  const cgsr::test::AllocationGuard guard;
  divergence.of(world.image, {10, 10, 60, 60});
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::color
