#include "pipeline/color/search/similarity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "pipeline/color/learn/learn.h"
#include "pipeline/color/search/similarity_rows.h"
#include "tests/color/scene.h"

namespace cgsr::color {
namespace {

ColorModel random_model(std::mt19937& random, int per_channel = 4, int light_steps = 2) {
  LearnParameters parameters;
  parameters.bins.per_channel = per_channel;
  parameters.lights.steps = light_steps;
  parameters.min_distinctiveness = 0.0;
  auto painting = test::clutter(64, 64, random);
  const Sample sample{painting.photograph(1.0), {16, 16, 32, 32}};
  return learn({&sample, 1}, parameters).value().model;
}

TEST(Level, IsTheNearestRootAndRisesWithTheCount) {
  for (const int pixels : {1, 9, 64, 577, 60000}) {
    int last = 0;
    for (int count = 0; count <= pixels; count += 1 + pixels / 999) {
      const int level = level_of(count, pixels);
      ASSERT_GE(level, last);
      const double root = std::sqrt(static_cast<double>(count) / pixels) * (kLevels - 1);
      ASSERT_NEAR(level, root, 0.5 + 1e-9) << count << " of " << pixels;
      last = level;
    }
    EXPECT_EQ(level_of(pixels, pixels), kLevels - 1);
    EXPECT_EQ(level_of(pixels + 5, pixels), kLevels - 1);
    EXPECT_EQ(level_of(0, pixels), 0);
  }
}

TEST(LevelTableProperty, IsLevelOfAsATable) {
  LevelTable table;
  for (const int pixels : {1, 9, 64, 577, 9000}) {
    table.prepare(pixels, 20000);
    const int row = table.data()[pixels] / (kLevels - 1);
    for (int count = 0; count <= 20000; ++count) ASSERT_EQ(table.data()[count], row * level_of(count, pixels)) << count;
  }
}

TEST(Labels, AreTheLearnedBinsByMassAndNothingElse) {
  std::mt19937 random(61);
  const ColorModel model = random_model(random);
  const Labels labels = labels_of(model);
  const auto bins = static_cast<std::size_t>(model.bins.count());
  int last = kHistogramMass * static_cast<int>(model.lights.size());
  std::vector<bool> learned(bins, false);
  for (const int bin : labels.bins) {
    int mass = 0;
    for (std::size_t light = 0; light < model.lights.size(); ++light)
      mass += model.object_under(light)[static_cast<std::size_t>(bin)];
    EXPECT_GT(mass, 0);
    EXPECT_LE(mass, last);
    last = mass;
    learned[static_cast<std::size_t>(bin)] = true;
  }
  for (int code = 0; code < imaging::kColorCodes; code += 7) {
    const int bin = imaging::bin_of(model.bins, imaging::rgb_of_code(static_cast<std::uint16_t>(code)));
    const int label = labels.of_code[static_cast<std::size_t>(code)];
    ASSERT_EQ(label > 0, learned[static_cast<std::size_t>(bin)]);
    if (label > 0) {
      ASSERT_EQ(labels.bins[static_cast<std::size_t>(label - 1)], bin);
    }
  }
}

// Plain mode: the whole units mean the divergence of the exact histograms, up to the rounding of levels.
TEST(SimilarityProperty, PlainUnitsAreTheDivergence) {
  std::mt19937 random(62);
  for (const auto& [name, divergence] : kDivergenceNames) {
    for (int trial = 0; trial < 20; ++trial) {
      const ColorModel model = random_model(random);
      SearchParameters parameters;
      parameters.divergence = divergence;
      parameters.weights = BinWeights::kPlain;
      const Labels labels = labels_of(model);
      const Similarity similarity(model, parameters, labels);

      // A window with some of the learned colours, some of them too often, and some strangers.
      const int pixels = 900;
      std::vector<int> counts(labels.bins.size() + 1, 0);
      for (int pixel = 0; pixel < pixels; ++pixel)
        ++counts[random() % 4 == 0 ? 0 : random() % std::min<std::size_t>(12, counts.size())];
      for (int light = 0; light < similarity.lights(); ++light) {
        int units = 0;
        double exact = 0.0;
        for (int label = 1; label <= similarity.labels(); ++label) {
          const auto at = static_cast<std::size_t>(label);
          units += similarity.units(label, level_of(counts[at], pixels), light);
          const double q =
              1.0 * model.object_under(static_cast<std::size_t>(light))[static_cast<std::size_t>(labels.bins[at - 1])] /
              kHistogramMass;
          exact += similarity_term(divergence, 1.0 * counts[at] / pixels, q);
        }
        ASSERT_NEAR(units, kOne * exact, kOne * 0.012) << name;
      }
    }
  }
}

// Both modes: the learned histogram itself is at (almost) no divergence under its light, and nothing is nearer than that.
TEST(SimilarityProperty, TheLearnedHistogramIsNearest) {
  std::mt19937 random(63);
  for (const auto weights : {BinWeights::kPlain, BinWeights::kSurroundings}) {
    for (int trial = 0; trial < 20; ++trial) {
      const ColorModel model = random_model(random);
      SearchParameters parameters;
      parameters.weights = weights;
      const Labels labels = labels_of(model);
      const Similarity similarity(model, parameters, labels);
      for (int light = 0; light < similarity.lights(); ++light) {
        int own = 0, most = 0;
        for (int label = 1; label <= similarity.labels(); ++label) {
          const int count = model.object_under(static_cast<std::size_t>(
              light))[static_cast<std::size_t>(labels.bins[static_cast<std::size_t>(label - 1)])];
          own += similarity.units(label, level_of(count, kHistogramMass), light);
          most += weights == BinWeights::kSurroundings ? similarity.units(label, kLevels - 1, light) : 0;
        }
        ASSERT_NEAR(own, kOne, 0.01 * kOne) << light;
        if (weights == BinWeights::kSurroundings) {
          ASSERT_LE(most, kOne) << light;
        }
      }
    }
  }
}

// What the surroundings have in plenty weighs little: without it the object is still near; without what is its own it is not.
TEST(Similarity, SurroundingsTakeWeightAway) {
  test::Painting painting(96, 96);
  const Box box{32, 24, 32, 48};
  painting.paint([](int, int) { return imaging::Rgb{0.25, 0.45, 0.25}; });
  painting.fill(box, {0.7, 0.15, 0.1});
  painting.fill({box.x, box.y, box.width, 24}, {0.25, 0.45, 0.25});  // half of the box is wall
  const Sample sample{painting.photograph(), box};
  LearnParameters learning;
  learning.lights.steps = 1;
  const auto model = learn({&sample, 1}, learning).value().model;
  const Labels labels = labels_of(model);
  const auto share_of = [&](const imaging::Rgb& color, BinWeights weights) {
    SearchParameters parameters;
    parameters.weights = weights;
    const Similarity similarity(model, parameters, labels);
    const auto yuv = imaging::yuv_of_rgb(color);
    const auto code =
        imaging::color_code(static_cast<int>(std::lround(4 * yuv.y)), static_cast<int>(std::lround(2 * yuv.u)),
                            static_cast<int>(std::lround(2 * yuv.v)));
    const int label = labels.of_code[code];
    return label == 0 ? 0.0 : 1.0 * similarity.units(label, level_of(1, 2), 0) / kOne;
  };
  EXPECT_NEAR(share_of({0.25, 0.45, 0.25}, BinWeights::kPlain), 0.5, 0.05);
  EXPECT_NEAR(share_of({0.7, 0.15, 0.1}, BinWeights::kPlain), 0.5, 0.05);
  EXPECT_LT(share_of({0.25, 0.45, 0.25}, BinWeights::kSurroundings), 0.3);
  EXPECT_GT(share_of({0.7, 0.15, 0.1}, BinWeights::kSurroundings), 0.7);
}

// Bounds hold: of any group, given by what its windows have at most and at least, no window exceeds the bound, refined or not.
TEST(SimilarityRowsProperty, BoundsHold) {
  std::mt19937 random(64);
  for (int trial = 0; trial < 60; ++trial) {
    const ColorModel model =
        random_model(random, 3 + static_cast<int>(random() % 4), 1 + static_cast<int>(random() % 4));
    SearchParameters parameters;
    parameters.divergence = static_cast<Divergence>(random() % 3);
    parameters.weights = static_cast<BinWeights>(random() % 2);
    const Labels labels = labels_of(model);
    const Similarity similarity(model, parameters, labels);
    const SimilarityRows rows(similarity, parameters);
    for (int question = 0; question < 50; ++question) {
      // A window of `pixels`, of which `shared` are in every window of the group, and others that the group may have besides.
      const int pixels = 50 + static_cast<int>(random() % 400);
      const int shared = static_cast<int>(random() % static_cast<unsigned>(pixels));
      LabelHistogram least(labels.count()), window(labels.count()), most(labels.count());
      const unsigned kinds = 1 + random() % static_cast<unsigned>(labels.count());
      const auto any = [&] { return random() % 5 == 0 ? 0U : random() % (kinds + 1); };
      for (int i = 0; i < pixels; ++i) {
        const auto label = any();
        if (i < shared) ++least.counts()[label];
        ++window.counts()[label];
        ++most.counts()[label];
      }
      for (int i = static_cast<int>(random() % 300); i > 0; --i) ++most.counts()[any()];
      LevelTable levels;
      levels.prepare(pixels, 1000);

      std::vector<int> sums(static_cast<std::size_t>(similarity.lights()), 0);
      for (int label = 1; label <= labels.count(); ++label) {
        for (int light = 0; light < similarity.lights(); ++light) {
          sums[static_cast<std::size_t>(light)] +=
              similarity.units(label, level_of(window.counts()[label], pixels), light);
        }
      }
      const auto expected = std::max_element(sums.begin(), sums.end());
      const BestLight best = rows.best(window, levels);
      ASSERT_EQ(best.units, std::min(*expected, kMaxUnits));
      ASSERT_EQ(best.light, expected - sums.begin());

      SimilarityRows::Bound bound;
      rows.bound(most, levels, bound);
      ASSERT_GE(bound.units, best.units);
      if (!bound.refinable) continue;
      const int before = bound.units;
      rows.refine(least, levels, shared, pixels, bound);
      ASSERT_LE(bound.units, before);
      ASSERT_GE(bound.units, best.units);
    }
  }
}

TEST(Units, ThresholdsAreTheLeastThatPass) {
  for (const auto& [name, divergence] : kDivergenceNames) {
    for (double limit = 0.01; limit < max_divergence(divergence); limit += 0.037) {
      const int least = min_units(divergence, limit);
      EXPECT_LE(divergence_of_units(divergence, least), limit) << name;
      EXPECT_GT(divergence_of_units(divergence, least - 1), limit) << name;
    }
    EXPECT_EQ(min_units(divergence, 0.0), kOne) << name;
    EXPECT_EQ(min_units(divergence, 1.0), 0) << name;
  }
}

}  // namespace
}  // namespace cgsr::color
