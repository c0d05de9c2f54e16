#include "pipeline/color/track/light_history.h"

#include <gtest/gtest.h>

namespace cgsr::color {
namespace {

constexpr Light kWarm{1.0, 0.8, 0.6};
constexpr Light kCold{0.6, 0.8, 1.0};

MonoTime at(double time_s) {
  return MonoTime{seconds(time_s)};
}

TEST(LightHistory, NothingFoundIsNoLight) {
  LightHistory history;
  EXPECT_FALSE(history.add(at(0.0), std::nullopt));
}

TEST(LightHistory, ThePluralityOfTheLastSecondWins) {
  LightHistory history;
  for (int i = 0; i < 20; ++i) history.add(at(i * 0.03), kWarm);
  const auto light = history.add(at(0.61), kCold);
  ASSERT_TRUE(light);
  EXPECT_EQ(light->r, kWarm.r);
}

TEST(LightHistory, WhatIsOlderThanASecondIsForgotten) {
  LightHistory history;
  for (int i = 0; i < 20; ++i) history.add(at(i * 0.01), kWarm);
  const auto light = history.add(at(1.3), kCold);
  ASSERT_TRUE(light);
  EXPECT_EQ(light->r, kCold.r);
  EXPECT_FALSE(history.add(at(2.31), std::nullopt));
}

TEST(LightHistory, OfEquallyFrequentLightsTheLastSeenWins) {
  LightHistory history;
  history.add(at(0.0), kWarm);
  EXPECT_EQ(history.add(at(0.1), kCold)->b, kCold.b);
}

TEST(LightHistory, MoreImagesThanItKeepsOverwriteTheOldest) {
  LightHistory history;
  for (int i = 0; i < 130; ++i) history.add(at(i * 1e-4), kWarm);
  std::optional<Light> light;
  for (int i = 0; i < 100; ++i) light = history.add(at(0.02 + i * 1e-4), kCold);
  EXPECT_EQ(light->b, kCold.b);
}

}  // namespace
}  // namespace cgsr::color
