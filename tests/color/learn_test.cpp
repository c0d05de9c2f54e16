#include "pipeline/color/learn/learn.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "tests/color/scene.h"

namespace cgsr::color {
namespace {

using ::testing::HasSubstr;

// Alg. 3.1 by hand on four pixels: pure red, dark red, grey, blue.
TEST(LearnGolden, TheAssumedLightIsTakenOut) {
  std::vector<imaging::Rgb> pixels{{1.0, 0.0, 0.0}, {0.4, 0.0, 0.0}, {0.4, 0.4, 0.4}, {0.0, 0.0, 0.6}};

  const Light light = take_out_light(pixels, 0.8);

  EXPECT_DOUBLE_EQ(light.r, 1.0);  // line 9: brighter than assumed
  EXPECT_DOUBLE_EQ(light.g, 0.8);  // lines 10, 11: the assumption
  EXPECT_DOUBLE_EQ(light.b, 0.8);
  EXPECT_DOUBLE_EQ(pixels[0].r, 1.0);
  EXPECT_DOUBLE_EQ(pixels[2].r, 0.4);
  EXPECT_DOUBLE_EQ(pixels[2].g, 0.5);
  EXPECT_DOUBLE_EQ(pixels[3].b, 0.75);
}

TEST(LearnGolden, HistogramsFollowTheDiagonalModel) {
  const std::vector<imaging::Rgb> textures{{1.0, 0.0, 0.0}, {0.4, 0.0, 0.0}, {0.4, 0.5, 0.5}, {0.0, 0.0, 0.75}};
  const imaging::ColorBins bins{imaging::ColorSpace::kRgb, 4};
  const auto at = [](int r, int g, int b) { return static_cast<std::size_t>((r * 4 + g) * 4 + b); };

  const auto full = histogram_under(textures, {1.0, 1.0, 1.0}, bins);
  EXPECT_DOUBLE_EQ(full[at(3, 0, 0)], 0.25);
  EXPECT_DOUBLE_EQ(full[at(1, 0, 0)], 0.25);
  EXPECT_DOUBLE_EQ(full[at(1, 2, 2)], 0.25);
  EXPECT_DOUBLE_EQ(full[at(0, 0, 3)], 0.25);

  const auto dim = histogram_under(textures, {0.6, 0.6, 0.6}, bins);
  EXPECT_DOUBLE_EQ(dim[at(2, 0, 0)], 0.25);  // 0.6
  EXPECT_DOUBLE_EQ(dim[at(0, 0, 0)], 0.25);  // 0.24
  EXPECT_DOUBLE_EQ(dim[at(0, 1, 1)], 0.25);  // 0.24, 0.3, 0.3
  EXPECT_DOUBLE_EQ(dim[at(0, 0, 1)], 0.25);  // 0.45
  EXPECT_DOUBLE_EQ(std::accumulate(dim.begin(), dim.end(), 0.0), 1.0);
}

constexpr imaging::Rgb kWall{0.55, 0.7, 0.55};  // in the middle of a bin under every light of the grid

struct Flag {
  Flag() : painting(160, 120) {
    painting.paint([](int, int) { return lit(kWall, {0.8, 0.8, 0.8}); });
    test::paint_flag(painting, box);
  }
  Box box{60, 30, 36, 48};
  test::Painting painting;
};

TEST(Learn, KeepsAHistogramPerLightOfObjectAndSurroundings) {
  Flag flag;
  const Sample sample{flag.painting.photograph(), flag.box};

  const auto learned = learn({&sample, 1}, {});

  ASSERT_TRUE(learned) << learned.error().message;
  const ColorModel& model = learned->model;
  EXPECT_EQ(defect_of(model), "");
  EXPECT_EQ(model.lights.size(), 27U);
  EXPECT_EQ(model.width_px, 36);
  EXPECT_EQ(model.height_px, 48);
  EXPECT_EQ(learned->widened_by, 0.0);
  EXPECT_THAT(learned->message, HasSubstr("distinctiveness"));
  ASSERT_EQ(model.samples.size(), 1U);
  EXPECT_NEAR(model.samples[0].light.r, 0.8, 0.02);
  // The green around it is in the surroundings' histograms and in none of the object's, whatever the light.
  for (std::size_t light = 0; light < model.lights.size(); ++light) {
    const auto green = static_cast<std::size_t>(imaging::bin_of(model.bins, lit(kWall, model.lights[light])));
    EXPECT_EQ(model.object_under(light)[green], 0) << light;
    EXPECT_GT(model.surroundings_under(light)[green], kHistogramMass / 2) << light;
  }
}

// The same thing seen under two lights: each view is relative to its own light, so that the two histograms are the same and so is their mean.
TEST(Learn, SamplesUnderDifferentLightsAgree) {
  Flag dim;
  Flag bright;
  test::paint_flag(dim.painting, dim.box, {0.8, 0.8, 0.8});
  test::paint_flag(bright.painting, bright.box, {1.0, 1.0, 1.0});
  const std::vector<Sample> both{{dim.painting.photograph(), dim.box}, {bright.painting.photograph(), bright.box}};

  const auto learned = learn(both, {});

  ASSERT_TRUE(learned);
  ASSERT_EQ(learned->model.samples.size(), 2U);
  EXPECT_NEAR(learned->model.samples[1].light.r, 0.95, 0.02);
  const auto full = learned->model.object_under(26);
  int occupied = 0;
  for (const auto count : full) occupied += count > kHistogramMass / 100 ? 1 : 0;
  EXPECT_LE(occupied, 6);
}

TEST(Learn, WidensWhatIsOfOneColourAndSaysWhy) {
  Flag flag;
  const Box inside_red{62, 30, 20, 14};
  const Sample sample{flag.painting.photograph(1.0), inside_red};

  const auto learned = learn({&sample, 1}, {});

  ASSERT_TRUE(learned) << learned.error().message;
  EXPECT_GT(learned->widened_by, 0.0);
  EXPECT_THAT(learned->message, HasSubstr("widened"));
  EXPECT_THAT(learned->message, HasSubstr("one colour explains"));
  EXPECT_GT(learned->model.width_px, inside_red.width);
  EXPECT_EQ(learned->model.object_box.width, inside_red.width);
  EXPECT_EQ(learned->windows[0].x + learned->model.object_box.x, inside_red.x);
}

TEST(LearnFault, RefusesWhatStaysOfOneColour) {
  test::Painting wall(160, 120);
  wall.paint([](int, int) { return imaging::Rgb{0.6, 0.3, 0.2}; });
  const Sample sample{wall.photograph(1.0), {40, 40, 40, 40}};
  const auto refused = learn({&sample, 1}, {});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("one colour explains"));
  EXPECT_THAT(refused.error().message, HasSubstr("surroundings do not help"));

  LearnParameters no_widening;
  no_widening.widen = false;
  const auto refused_at_once = learn({&sample, 1}, no_widening);
  ASSERT_FALSE(refused_at_once);
  EXPECT_THAT(refused_at_once.error().message, HasSubstr("widening is off"));
}

TEST(LearnFault, SaysWhichSampleIsWrongAndHow) {
  Flag flag;
  const ImageView image = flag.painting.photograph();
  const auto message = [&](const ImageView& view, const Box& box) {
    const std::vector<Sample> samples{{image, flag.box}, {view, box}};
    const auto learned = learn(samples, {});
    return learned ? std::string("learned") : learned.error().message;
  };
  EXPECT_THAT(message(image, {200, 30, 20, 20}),
              HasSubstr("sample 1: the box 200,30,20,20 lies outside the image of 160x120"));
  EXPECT_THAT(message(image, {150, 30, 40, 20}), HasSubstr("lies outside"));
  EXPECT_THAT(message(image, {-30, 30, 40, 20}), HasSubstr("lies outside"));
  EXPECT_THAT(message(image, {10, 10, 0, 20}), HasSubstr("lies outside"));
  EXPECT_THAT(message(image, {10, 10, -5, 20}), HasSubstr("lies outside"));
  EXPECT_THAT(message(image, {std::nan(""), 10, 20, 20}), HasSubstr("lies outside"));
  EXPECT_THAT(message(image, {10, 10, std::numeric_limits<double>::infinity(), 20}), HasSubstr("lies outside"));
  EXPECT_THAT(message(image, {10, 10, 1, 1}), HasSubstr("too small"));
  EXPECT_THAT(message({}, flag.box), HasSubstr("empty"));
  ImageView grey = image;
  grey.format = PixelFormat::kGrey8;
  EXPECT_THAT(message(grey, flag.box), HasSubstr("YUYV"));
  EXPECT_THAT(message(image, {130, 30, 40, 48}), HasSubstr("learned"));  // three quarters inside: cut off at the edge

  EXPECT_FALSE(learn({}, {}));
  LearnParameters dark;
  dark.lights.max_green_excess = -1.0;
  const Sample good{image, flag.box};
  EXPECT_THAT(learn({&good, 1}, dark).error().message, HasSubstr("no light"));
}

// Whatever the image, box and settings: either words, or a model that passes its own check.
TEST(LearnProperty, LearnsASoundModelOrSaysWhyNot) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> unit(-0.2, 1.0);
  int learned_models = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const int width = 16 + 2 * static_cast<int>(random() % 90), height = 16 + static_cast<int>(random() % 200);
    auto painting = test::clutter(width, height, random, static_cast<int>(random() % 12));
    const Sample sample{painting.photograph(random() % 2 * 2.0),
                        {unit(random) * width, unit(random) * height, unit(random) * width, unit(random) * height}};
    LearnParameters parameters;
    parameters.bins = {static_cast<imaging::ColorSpace>(random() % 3), 2 + static_cast<int>(random() % 8)};
    parameters.lights.steps = 1 + static_cast<int>(random() % 3);
    const auto learned = learn({&sample, 1}, parameters);
    if (!learned) {
      ASSERT_FALSE(learned.error().message.empty());
      continue;
    }
    ++learned_models;
    ASSERT_EQ(defect_of(learned->model), "") << trial;
  }
  EXPECT_GT(learned_models, 20);
}

}  // namespace
}  // namespace cgsr::color
