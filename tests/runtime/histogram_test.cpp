#include "pipeline/runtime/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace cgsr::runtime {
namespace {

TEST(Histogram, IsZeroWhenEmpty) {
  const Histogram histogram;
  EXPECT_EQ(histogram.count(), 0U);
  EXPECT_EQ(histogram.mean(), Duration{});
  EXPECT_EQ(histogram.quantile(0.99), Duration{});
}

TEST(Histogram, OneValueIsAllOfThem) {
  Histogram histogram;
  histogram.add(Duration{1'234'567});
  EXPECT_EQ(histogram.mean(), Duration{1'234'567});
  EXPECT_EQ(histogram.worst(), Duration{1'234'567});
  EXPECT_EQ(histogram.quantile(0.5), Duration{1'234'567});
  EXPECT_EQ(histogram.quantile(1.0), Duration{1'234'567});
}

TEST(Histogram, SmallValuesAreExact) {
  Histogram histogram;
  for (int ns = 0; ns < 32; ++ns) histogram.add(Duration{ns});
  for (int ns = 0; ns < 32; ++ns) EXPECT_EQ(histogram.quantile((ns + 1) / 32.0), Duration{ns});
}

TEST(Histogram, ExtremesStayInside) {
  Histogram histogram;
  histogram.add(Duration{-5});
  histogram.add(Duration::max() / 4);
  EXPECT_EQ(histogram.quantile(0.5), Duration{});
  EXPECT_EQ(histogram.worst(), Duration::max() / 4);
  EXPECT_GT(histogram.quantile(1.0), std::chrono::minutes(18));
}

// Against the sorted list, for values over nine orders of magnitude: never below the true quantile, never more than
// 1/16 above.
TEST(HistogramProperty, QuantilesAreTightUpperBounds) {
  std::mt19937_64 random(20261121);
  std::uniform_real_distribution<double> exponent(0.0, 9.0);
  for (int trial = 0; trial < 200; ++trial) {
    Histogram histogram;
    std::vector<std::int64_t> values;
    const auto count = 1 + random() % 500;
    std::int64_t sum = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      values.push_back(static_cast<std::int64_t>(std::pow(10.0, exponent(random))));
      histogram.add(Duration{values.back()});
      sum += values.back();
    }
    std::sort(values.begin(), values.end());
    for (const double share : {0.0, 0.1, 0.5, 0.9, 0.99, 1.0}) {
      const auto rank = std::max(1.0, std::ceil(share * static_cast<double>(count)));
      const auto truth = values[static_cast<std::size_t>(rank) - 1];
      const auto answer = histogram.quantile(share).count();
      ASSERT_GE(answer, truth) << trial << " " << share;
      ASSERT_LE(static_cast<double>(answer), static_cast<double>(truth) * 17.0 / 16.0) << trial << " " << share;
    }
    ASSERT_EQ(histogram.mean().count(), sum / static_cast<std::int64_t>(count));
    ASSERT_EQ(histogram.worst().count(), values.back());
  }
}

}  // namespace
}  // namespace cgsr::runtime
