#include "pipeline/color/track/light_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/color/scene.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::color {
namespace {

constexpr Box kBox{40, 30, 80, 60};

/// A surface of random colours, seen inside the box.
test::Painting surface(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.15, 0.75);
  test::Painting painting(160, 120);
  painting.paint([&](int, int) { return imaging::Rgb{0.5, 0.5, 0.5}; });
  for (int y = 0; y < 120; y += 6) {
    for (int x = 0; x < 160; x += 8)
      painting.fill({static_cast<double>(x), static_cast<double>(y), 8, 6}, {unit(random), unit(random), unit(random)});
  }
  return painting;
}

test::Painting under(const test::Painting& painting, const Light& gain) {
  test::Painting changed = painting;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) changed.at(x, y) = lit(changed.at(x, y), gain);
  }
  return changed;
}

ChannelQuantiles quantiles(test::Painting painting, double noise, std::uint32_t seed) {
  imaging::Pyramid image(160, 120);
  const ImageView view = painting.photograph(noise, seed);
  image.build(view);
  return channel_quantiles(view_object(image, kBox));
}

void expect_gain(const Light& found, const Light& gain, double tolerance, int trial) {
  EXPECT_NEAR(found.r / gain.r, 1.0, tolerance) << trial;
  EXPECT_NEAR(found.g / gain.g, 1.0, tolerance) << trial;
  EXPECT_NEAR(found.b / gain.b, 1.0, tolerance) << trial;
}

TEST(LightGainProperty, FindsTheGainOfEachChannelUnderNoise) {
  std::mt19937 random(81);
  std::uniform_real_distribution<double> level(0.6, 1.25);
  for (int trial = 0; trial < 60; ++trial) {
    const auto painting = surface(random);
    const Light gain{level(random), level(random), level(random)};
    const auto learned = quantiles(painting, 2.0, random());
    const auto seen = quantiles(under(painting, gain), 2.0, random());
    expect_gain(light_gain(learned, seen), gain, 0.03, trial);
  }
}

// Where a tenth of evenly spread colours (0.15 to 0.75) has turned white, the median is what was at rank 0.56 before: 7 % brighter; lower
// quantiles are off by more and weigh less. A foreign tenth may pull by about its own size, not by a multiple of it.
TEST(LightGainProperty, IsPulledByATenthOfForeignPixelsByNoMoreThanThat) {
  std::mt19937 random(82);
  std::uniform_real_distribution<double> level(0.65, 1.2), unit(0.0, 1.0);
  constexpr int kTrials = 60;
  double mean = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto painting = surface(random);
    const Light gain{level(random), level(random), level(random)};
    auto changed = under(painting, gain);
    // What counts is the box without its outer tenth: 64 x 48 pixels. A stripe of a tenth of that, of any colour.
    changed.fill({48, 36 + std::floor(40 * unit(random)), 64, 5}, {unit(random), unit(random), unit(random)});
    const auto learned = quantiles(painting, 1.0, random());
    const auto seen = quantiles(changed, 1.0, random());

    const Light found = light_gain(learned, seen);

    expect_gain(found, gain, 0.16, trial);
    mean += (std::abs(found.r / gain.r - 1) + std::abs(found.g / gain.g - 1) + std::abs(found.b / gain.b - 1)) / 3;
  }
  EXPECT_LT(mean / kTrials, 0.065);
}

TEST(LightGain, OfTheSameSightIsOne) {
  std::mt19937 random(83);
  const auto sight = quantiles(surface(random), 0.0, 1);
  expect_gain(light_gain(sight, sight), {1, 1, 1}, 1e-9, 0);
}

// What is cut off at white or black says nothing; when nothing is left, nothing changed.
TEST(LightGain, CutOffValuesDoNotCount) {
  ChannelQuantiles learned, seen;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < ChannelQuantiles::kCount; ++i) {
      learned.values[k][i] = 0.3 + 0.02 * static_cast<double>(i);
      seen.values[k][i] = std::min(1.0, 1.5 * learned.values[k][i]);
    }
  }
  expect_gain(light_gain(learned, seen), {1.5, 1.5, 1.5}, 1e-6, 0);
  for (auto& channel : seen.values) channel.fill(1.0);
  expect_gain(light_gain(learned, seen), {1, 1, 1}, 1e-9, 1);
}

TEST(ChannelQuantilesProperty, RiseAndSayWhatShareIsBelow) {
  std::mt19937 random(84);
  for (int trial = 0; trial < 40; ++trial) {
    auto painting = surface(random);
    const auto found = quantiles(painting, 0.0, 1);
    // The same from the painting's own colours. Patches of 8x6 are smeared at their edges only.
    std::array<std::vector<double>, 3> values;
    for (int y = 36; y < 84; ++y) {
      for (int x = 48; x < 112; ++x) {
        values[0].push_back(painting.at(x, y).r);
        values[1].push_back(painting.at(x, y).g);
        values[2].push_back(painting.at(x, y).b);
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      std::sort(values[k].begin(), values[k].end());
      ASSERT_TRUE(std::is_sorted(found.values[k].begin(), found.values[k].end()));
      double error = 0.0;
      for (std::size_t i = 0; i < ChannelQuantiles::kCount; ++i) {
        const double expected = values[k][values[k].size() * (2 * i + 1) / (2 * ChannelQuantiles::kCount)];
        error += std::abs(found.values[k][i] - expected) / ChannelQuantiles::kCount;
      }
      EXPECT_LT(error, 0.03) << trial;
    }
  }
}

TEST(ChannelQuantiles, LeaveTheOuterTenthOut) {
  test::Painting painting(160, 120);
  painting.paint([](int, int) { return imaging::Rgb{0.9, 0.9, 0.9}; });
  painting.fill({46, 34, 68, 52}, {0.4, 0.5, 0.6});  // the box less 6 and 4 pixels: more than what is left of it
  const auto found = quantiles(painting, 0.0, 1);
  for (std::size_t i = 0; i < ChannelQuantiles::kCount; ++i) {
    EXPECT_NEAR(found.values[0][i], 0.4, 0.01);
    EXPECT_NEAR(found.values[1][i], 0.5, 0.01);
    EXPECT_NEAR(found.values[2][i], 0.6, 0.01);
  }
}

TEST(NearestLightProperty, IsTheNearestOfAll) {
  std::mt19937 random(85);
  std::uniform_real_distribution<double> level(0.4, 1.2);
  ColorModel model;
  model.lights = light_grid({});
  for (int trial = 0; trial < 500; ++trial) {
    const Light light{level(random), level(random), level(random)};
    const Light nearest = nearest_of(model, light);
    const auto nearest_level = [](double value) { return value < 0.7 ? 0.6 : value < 0.9 ? 0.8 : 1.0; };
    ASSERT_NEAR(nearest.r, nearest_level(light.r), 1e-9);
    ASSERT_NEAR(nearest.g, nearest_level(light.g), 1e-9);
    ASSERT_NEAR(nearest.b, nearest_level(light.b), 1e-9);
  }
}

TEST(LightEstimateAlloc, Nothing) {
  if (!cgsr::test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  std::mt19937 random(86);
  auto painting = surface(random);
  const ImageView view = painting.photograph();
  imaging::Pyramid image(160, 120);
  image.build(view);
  const cgsr::test::AllocationGuard guard;
  const auto sight = channel_quantiles(view_object(image, kBox));
  const Light gain = light_gain(sight, sight);
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_NEAR(gain.r, 1.0, 1e-9);
}

}  // namespace
}  // namespace cgsr::color
