#include "pipeline/color/learn/light.h"

#include <gtest/gtest.h>

namespace cgsr::color {
namespace {

TEST(LightGrid, TheDissertationsHas27) {
  const auto lights = light_grid({});
  ASSERT_EQ(lights.size(), 27U);
  EXPECT_DOUBLE_EQ(lights.front().r, 0.6);
  EXPECT_DOUBLE_EQ(lights[1].b, 0.8);
  EXPECT_DOUBLE_EQ(lights.back().g, 1.0);
}

TEST(LightGrid, OneStepIsTheMiddle) {
  LightParameters parameters;
  parameters.steps = 1;
  const auto lights = light_grid(parameters);
  ASSERT_EQ(lights.size(), 1U);
  EXPECT_DOUBLE_EQ(lights[0].g, 0.8);
}

TEST(LightGrid, LeavesOutGreenLamps) {
  LightParameters parameters;
  parameters.max_green_excess = 0.25;
  const auto lights = light_grid(parameters);
  EXPECT_EQ(lights.size(), 24U);  // not (0.6, 1, 0.6), (0.6, 1, 0.8), (0.8, 1, 0.6)
  for (const auto& light : lights) EXPECT_LE(light.g - (light.r + light.b) / 2, 0.25);
}

TEST(LightGrid, AnEmptyRangeHasNone) {
  LightParameters parameters;
  parameters.min_level = 0.9;
  parameters.max_level = 0.7;
  EXPECT_TRUE(light_grid(parameters).empty());
}

TEST(Light, TakingOutUndoesLighting) {
  const imaging::Rgb texture{0.3, 0.6, 0.9};
  const Light light{0.6, 0.8, 1.0};
  const auto back = without_light(lit(texture, light), light);
  EXPECT_DOUBLE_EQ(back.r, texture.r);
  EXPECT_DOUBLE_EQ(back.g, texture.g);
  EXPECT_DOUBLE_EQ(back.b, texture.b);
}

}  // namespace
}  // namespace cgsr::color
