#include "pipeline/imaging/color_bins.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace cgsr::imaging {
namespace {

TEST(ColorBins, RgbCountsRedMost) {
  const ColorBins bins{ColorSpace::kRgb, 8};
  EXPECT_EQ(bin_of(bins, {0.0, 0.0, 0.0}), 0);
  EXPECT_EQ(bin_of(bins, {0.0, 0.0, 0.130}), 1);
  EXPECT_EQ(bin_of(bins, {0.0, 0.130, 0.0}), 8);
  EXPECT_EQ(bin_of(bins, {0.130, 0.0, 0.0}), 64);
  EXPECT_EQ(bin_of(bins, {1.0, 1.0, 1.0}), 511);
  EXPECT_EQ(bin_of(bins, {0.124, 0.126, 0.99}), 8 + 7);
}

TEST(ColorBins, WhatIsOutsideIsCutOff) {
  const ColorBins bins{ColorSpace::kRgb, 8};
  EXPECT_EQ(bin_of(bins, {1.7, 2.0, 1.0}), 511);
  EXPECT_EQ(bin_of(bins, {-0.5, 0.0, 0.0}), 0);
}

TEST(ColorBins, HsvPutsHuesSaturationsAndValuesApart) {
  const ColorBins bins{ColorSpace::kHsv, 6};
  EXPECT_EQ(bin_of(bins, {1, 0, 0}), (0 * 6 + 5) * 6 + 5);        // red
  EXPECT_EQ(bin_of(bins, {1, 1, 0}), (1 * 6 + 5) * 6 + 5);        // yellow: 60 degrees
  EXPECT_EQ(bin_of(bins, {0, 1, 0}), (2 * 6 + 5) * 6 + 5);        // green
  EXPECT_EQ(bin_of(bins, {0, 0, 1}), (4 * 6 + 5) * 6 + 5);        // blue
  EXPECT_EQ(bin_of(bins, {1, 0, 0.01}), (5 * 6 + 5) * 6 + 5);     // just below 360 degrees
  EXPECT_EQ(bin_of(bins, {0.5, 0.5, 0.5}), (0 * 6 + 0) * 6 + 3);  // grey has hue 0
  EXPECT_EQ(bin_of(bins, {0.0, 0.0, 0.0}), 0);
}

TEST(ColorBins, YuvOfGreysHasNeutralChroma) {
  const ColorBins bins{ColorSpace::kYuv, 8};
  EXPECT_EQ(bin_of(bins, {1, 1, 1}), (7 * 8 + 4) * 8 + 4);
  EXPECT_EQ(bin_of(bins, {0, 0, 0}), (0 * 8 + 4) * 8 + 4);
}

TEST(ColorBinsProperty, EveryColourHasABin) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> channel(0.0, 1.0);
  for (const auto& space : kColorSpaceNames) {
    for (int per_channel = 2; per_channel <= 16; ++per_channel) {
      const ColorBins bins{space.value, per_channel};
      std::set<int> seen;
      for (int trial = 0; trial < 2000; ++trial) {
        const int bin = bin_of(bins, {channel(random), channel(random), channel(random)});
        ASSERT_GE(bin, 0);
        ASSERT_LT(bin, bins.count());
        seen.insert(bin);
      }
      EXPECT_GE(static_cast<int>(seen.size()), std::min(bins.count() / 5, 250)) << space.name << per_channel;
    }
  }
}

}  // namespace
}  // namespace cgsr::imaging
