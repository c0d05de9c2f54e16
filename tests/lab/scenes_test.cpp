#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "tools/lab/scenes/clutter.h"
#include "tools/lab/scenes/moving_scene.h"
#include "tools/lab/scenes/scene.h"

namespace cgsr::lab {
namespace {

/// FNV-1a: tells two images apart.
std::uint64_t fingerprint(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001B3ULL;
  return hash;
}

// The published test vector of SplitMix64 with seed 1234567.
TEST(RandomGolden, IsSplitMix64) {
  Random random(1234567);

  for (std::uint64_t expected :
       {6457827717110365317ULL, 3203168211198807973ULL, 9817491932198370423ULL, 4593380528125082431ULL}) {
    EXPECT_EQ(random.next(), expected);
  }
}

TEST(RandomProperty, NormalHasMeanZeroAndVarianceOne) {
  Random random(1);
  double sum = 0.0, squares = 0.0;
  constexpr int kDraws = 100000;
  for (int i = 0; i < kDraws; ++i) {
    const double value = random.normal();
    sum += value;
    squares += value * value;
  }

  EXPECT_NEAR(sum / kDraws, 0.0, 0.02);
  EXPECT_NEAR(squares / kDraws, 1.0, 0.02);
}

TEST(HsvProperty, HueSurvivesTheWayThere) {
  Random random(2);
  for (int trial = 0; trial < 1000; ++trial) {
    const double hue = random.uniform(), saturation = random.uniform(0.1, 1.0);

    const Rgb color = to_rgb({hue, saturation, random.uniform(0.1, 1.0)});

    EXPECT_LT(hue_distance(hue_of(color), hue), 1e-9) << trial;
    EXPECT_NEAR(saturation_of(color), saturation, 1e-9) << trial;
  }
}

// The bytes are part of what a seed means: figures that were printed once can be printed again.
TEST(ObjectWorldGolden, SameSeedSameBytes) {
  const ObjectWorld world(42);
  std::optional<Box> truth;

  const Image image = world.scene(3, {0.9, 0.7, 0.65}, true, 1.0, truth);

  EXPECT_EQ(fingerprint(world.learning_image().yuyv), 687777422076039531ULL);
  EXPECT_EQ(fingerprint(image.yuyv), 15809460253390388912ULL);
}

TEST(ObjectWorld, AnotherSeedAndAnotherSceneAreOtherImages) {
  const ObjectWorld one(1), two(2);
  std::optional<Box> truth;

  EXPECT_NE(one.learning_image().yuyv, two.learning_image().yuyv);
  EXPECT_NE(one.scene(0, {0.8, 0.8, 0.8}, true, 1.0, truth).yuyv, one.scene(1, {0.8, 0.8, 0.8}, true, 1.0, truth).yuyv);
}

TEST(ObjectWorldProperty, TheObjectLiesInsideAndIsAsLargeAsAsked) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const ObjectWorld world(seed);
    for (double scale : {0.8, 1.0, 1.25}) {
      std::optional<Box> truth;
      (void)world.scene(0, {0.8, 0.8, 0.8}, true, scale, truth);
      ASSERT_TRUE(truth);
      EXPECT_EQ(intersection(*truth, {0, 0, kSceneWidthPx, kSceneHeightPx}), *truth) << seed;
      EXPECT_NEAR(truth->width, scale * world.learning_box().width, 0.5) << seed;
    }
  }
}

TEST(ObjectWorld, AnAbsentObjectHasNoTruthAndLeavesItsPlaceToTheClutter) {
  const ObjectWorld world(5);
  std::optional<Box> present, absent;
  const Image with = world.scene(0, {0.8, 0.8, 0.8}, true, 1.0, present);
  const Image without = world.scene(0, {0.8, 0.8, 0.8}, false, 1.0, absent);

  EXPECT_FALSE(absent);
  ASSERT_TRUE(present);
  EXPECT_NE(with.yuyv, without.yuyv);
}

// What line 3 of the scenes' promise rests on: a third of the background has the object's hues, whatever they are.
TEST(ClutterProperty, AThirdSharesTheObjectsHues) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Pattern pattern{Random(seed)};

    const Canvas canvas =
        random_clutter(kSceneWidthPx, kSceneHeightPx, pattern.palette(), kSharedHues, Random(seed + 100));

    EXPECT_NEAR(share_of_hues(canvas, pattern.palette()), kSharedHues, 0.02) << seed;
  }
}

TEST(PatternProperty, ShowsEveryColorOfItsPaletteAndNothingAboveOne) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Pattern pattern{Random(seed)};
    ASSERT_GE(pattern.palette().size(), 3U);
    std::vector<int> seen(pattern.palette().size());
    for (int i = 0; i < 64 * 64; ++i) {
      const Rgb color = pattern.at(i % 64 / 64.0, i / 64 / 64.0);
      ASSERT_LE(std::max({color.r, color.g, color.b}), 1.0);
      for (std::size_t c = 0; c < seen.size(); ++c) {
        seen[c] += hue_distance(hue_of(color), hue_of(pattern.palette()[c])) < kSameHue ? 1 : 0;
      }
    }
    for (std::size_t c = 0; c < seen.size(); ++c) EXPECT_GT(seen[c], 0) << "seed " << seed << " color " << c;
  }
}

/// Mean R, G, B inside a box, decoded in full precision.
Rgb mean_color(const Image& image, const Box& box) {
  Rgb sum;
  double count = 0;
  for (int y = static_cast<int>(box.y); y < static_cast<int>(box.y + box.height); ++y) {
    for (int x = static_cast<int>(box.x) & ~1; x < static_cast<int>(box.x + box.width); x += 2) {
      const std::uint8_t* pair = image.view().row(y) + static_cast<std::ptrdiff_t>(x) * 2;
      const double luma = ((pair[0] + pair[2]) / 2.0 - 16) / 219, u = (pair[1] - 128) / 224.0,
                   v = (pair[3] - 128) / 224.0;
      sum = sum + Rgb{luma + 1.402 * v, luma - 0.344136 * u - 0.714136 * v, luma + 1.772 * u};
      count += 1;
    }
  }
  return sum * (1.0 / count);
}

// The diagonal model: relative to the learning image, every channel of the object is scaled by light / assumed light.
TEST(ObjectWorldProperty, LightScalesTheLearnedColorsChannelByChannel) {
  Random random(11);
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const ObjectWorld world(seed);
    const Light light{random.uniform(0.6, 1.0), random.uniform(0.6, 1.0), random.uniform(0.6, 1.0)};
    std::optional<Box> truth;

    const Image image = world.scene(0, light, true, 1.0, truth);

    const Rgb learned = mean_color(world.learning_image(), world.learning_box()), seen = mean_color(image, *truth);
    const Light& assumed = world.assumed_light();
    EXPECT_NEAR(seen.r, learned.r * light.r / assumed.r, 0.02) << seed;
    EXPECT_NEAR(seen.g, learned.g * light.g / assumed.g, 0.02) << seed;
    EXPECT_NEAR(seen.b, learned.b * light.b / assumed.b, 0.02) << seed;
  }
}

TEST(AbsoluteLight, IsRelativeToWhatLearningAssumed) {
  const Light light = absolute_light({0.6, 0.9, 1.0}, {0.8, 0.9, 1.0});

  EXPECT_DOUBLE_EQ(light.r, 0.6);
  EXPECT_DOUBLE_EQ(light.g, 0.8);
  EXPECT_DOUBLE_EQ(light.b, 0.8);
}

TEST(AssumedLight, IsTheBrightestChannelAndAtLeastTheLearningLight) {
  std::vector<std::uint8_t> bytes(2 * 16 * 16);
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    bytes[i] = 100;
    bytes[i + 1] = 128;
  }
  bytes[2 * (5 * 16 + 6)] = 235;  // one white pixel
  const Image image = image_of_yuyv(bytes, 16, 16);

  EXPECT_NEAR(assumed_light(image.view(), {4, 4, 8, 8}).g, 1.0, 1e-9);
  EXPECT_NEAR(assumed_light(image.view(), {8, 8, 8, 8}).g, 0.8, 1e-9);
}

TEST(MovingSceneProperty, MovesSmoothlyInsideTheImageAndHidesOnce) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const MovingScene film(seed, 150);
    ASSERT_TRUE(film.truth().front());
    int hidden = 0;
    for (std::size_t i = 0; i < film.truth().size(); ++i) {
      const auto& box = film.truth()[i];
      hidden += !box;
      if (!box) continue;
      const Box cut = intersection(*box, {0, 0, kSceneWidthPx, kSceneHeightPx});
      EXPECT_NEAR(cut.area(), box->area(), 1e-6) << seed << " image " << i;
      if (i == 0 || !film.truth()[i - 1]) continue;
      EXPECT_LT(std::abs(box->x - film.truth()[i - 1]->x), 10.0) << seed << " image " << i;
      EXPECT_LT(std::abs(box->width / film.truth()[i - 1]->width - 1.0), 0.02) << seed << " image " << i;
    }
    EXPECT_NEAR(hidden, 0.15 * 150, 2) << seed;
  }
}

TEST(MovingSceneGolden, SameSeedSameBytes) {
  const MovingScene film(7, 60);

  EXPECT_EQ(fingerprint(film.image(0).yuyv), 15564357238725470837ULL);
  EXPECT_EQ(fingerprint(film.image(59).yuyv), 7044233450650612589ULL);
}

}  // namespace
}  // namespace cgsr::lab
