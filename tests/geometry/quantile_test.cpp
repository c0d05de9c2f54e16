#include "pipeline/geometry/quantile.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace cgsr::geometry {
namespace {

TEST(Quantile, IsAValueOfTheSortedOnes) {
  const std::vector<double> values{5.0, 1.0, 4.0, 2.0, 3.0};
  EXPECT_EQ(quantile(values, 0.0), 1.0);
  EXPECT_EQ(quantile(values, 0.5), 3.0);
  EXPECT_EQ(quantile(values, 0.95), 5.0);
  EXPECT_EQ(quantile(values, 1.0), 5.0);
  EXPECT_EQ(quantile(std::vector<double>{1.0, 2.0, 3.0, 4.0}, 0.5), 3.0) << "the upper one of the middle two";
  EXPECT_EQ(quantile(std::vector<double>{}, 0.5), 0.0);
}

// Whatever the values, exactly floor(share n) of them sort before the answer, or are equal to it.
TEST(Quantile, SplitsAnyValuesAtItsShare) {
  std::mt19937 random(20261124);
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<float> values(1 + random() % 40);
    for (float& value : values) value = static_cast<float>(random() % 12);
    const double share = 0.01 * static_cast<double>(random() % 101);
    std::vector<float> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const auto index =
        std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));

    ASSERT_EQ(quantile(values, share), sorted[index]) << trial;
  }
}

}  // namespace
}  // namespace cgsr::geometry
