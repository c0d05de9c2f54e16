#include "pipeline/color/ball/ball_likeness.h"

#include <gtest/gtest.h>

namespace cgsr::color {
namespace {

constexpr double kBright = 0.8, kDim = 0.5, kDark = 0.3;

TEST(LightInShade, NothingIsTooDarkBeforeTheBallHasBeenSeenInShade) {
  LightInShade light;
  for (int i = 0; i < 4; ++i) light.add(kBright);
  EXPECT_TRUE(light.is_plausible(kDark));
  for (int i = 0; i < 2; ++i) light.add(kBright);
  EXPECT_FALSE(light.is_plausible(kDark));
  EXPECT_FALSE(light.is_plausible(kDim));
  EXPECT_TRUE(light.is_plausible(kBright));
  EXPECT_TRUE(light.is_plausible(1.0));
}

TEST(LightInShade, AsDarkAsItHasBeenIsPlausible) {
  LightInShade light;
  for (int i = 0; i < 20; ++i) light.add(i % 4 == 0 ? kDim : kBright);
  EXPECT_TRUE(light.is_plausible(kDim));
  EXPECT_TRUE(light.is_plausible(0.9 * kDim)) << "the next light of the model is as near";
  EXPECT_FALSE(light.is_plausible(kDark));
}

TEST(LightInShade, OnceInTenIsEnough) {
  LightInShade light;
  light.add(kDark);
  for (int i = 0; i < 9; ++i) light.add(kBright);
  EXPECT_TRUE(light.is_plausible(kDark));
  for (int i = 0; i < 5; ++i) light.add(kBright);
  EXPECT_FALSE(light.is_plausible(kDark));
}

// Curtains are drawn while the ball is out of view.
TEST(LightInShade, WhatWasSeenLongAgoSaysNothing) {
  LightInShade light;
  for (int i = 0; i < 30 * 60; ++i) {
    light.fade();
    light.add(kBright);
  }
  for (int i = 0; i < 30 * 30; ++i) light.fade();
  EXPECT_FALSE(light.is_plausible(kDark)) << "half a minute later";
  for (int i = 0; i < 30 * 60; ++i) light.fade();
  EXPECT_TRUE(light.is_plausible(kDark)) << "a minute and a half later";
}

TEST(LightInShade, WhatIsSeenNowCounts) {
  LightInShade light;
  for (int i = 0; i < 1000; ++i) {
    light.fade();
    light.add(kBright);
  }
  EXPECT_FALSE(light.is_plausible(kDark));
  for (int i = 0; i < 60; ++i) {
    light.fade();
    light.add(kDark);
  }
  EXPECT_TRUE(light.is_plausible(kDark));
}

TEST(LightInShadeFault, GainsOutsideOfAllThatIsUsualAreCounted) {
  LightInShade light;
  for (int i = 0; i < 6; ++i) light.add(100.0);
  EXPECT_FALSE(light.is_plausible(0.0));
  EXPECT_TRUE(light.is_plausible(50.0));
}

}  // namespace
}  // namespace cgsr::color
