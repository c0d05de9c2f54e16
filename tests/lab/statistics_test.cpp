#include "tools/lab/statistics.h"

#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tools/lab/scenes/random.h"

namespace cgsr::lab {
namespace {

// Published values of Wilson's interval (Newcombe 1998, Table I, method 3).
TEST(WilsonGolden, PublishedIntervals) {
  EXPECT_NEAR(wilson(81, 263).low, 0.2553, 5e-5);
  EXPECT_NEAR(wilson(81, 263).high, 0.3662, 5e-5);
  EXPECT_NEAR(wilson(15, 148).low, 0.0624, 5e-5);
  EXPECT_NEAR(wilson(15, 148).high, 0.1605, 5e-5);
  EXPECT_NEAR(wilson(0, 20).low, 0.0, 1e-12);
  EXPECT_NEAR(wilson(0, 20).high, 0.1611, 5e-5);
  EXPECT_NEAR(wilson(1, 29).low, 0.0061, 5e-5);
  EXPECT_NEAR(wilson(1, 29).high, 0.1718, 5e-5);
}

TEST(Wilson, NoTrialsSayNothing) {
  EXPECT_EQ(wilson(0, 0).low, 0.0);
  EXPECT_EQ(wilson(0, 0).high, 1.0);
}

/// The share of experiments whose interval holds the true mean 0.5.
double coverage(int values_each, int block, double persistence) {
  Random random(7);
  int held = 0;
  constexpr int kExperiments = 200;
  for (int experiment = 0; experiment < kExperiments; ++experiment) {
    std::vector<double> values;
    double value = random.uniform();
    for (int i = 0; i < values_each; ++i) {
      if (!random.chance(persistence)) value = random.uniform();
      values.push_back(value);
    }
    const Interval interval = bootstrap_mean(values, block, random.next());
    held += interval.low <= 0.5 && 0.5 <= interval.high;
  }
  return held / static_cast<double>(kExperiments);
}

TEST(BootstrapProperty, HoldsTheMeanOfIndependentValuesInNineteenOfTwentyCases) {
  EXPECT_NEAR(coverage(60, 1, 0.0), 0.94, 0.035);
}

// Neighbours that resemble each other: drawn one by one they pretend to be more evidence than they are, drawn in blocks hardly.
TEST(BootstrapProperty, BlocksHoldTheMeanOfValuesThatPersist) {
  EXPECT_LT(coverage(200, 1, 0.8), 0.75);
  EXPECT_GT(coverage(200, 20, 0.8), 0.78);
}

// Student's own data (1908), the hours of sleep gained by two drugs: t = 4.0621, p = 0.002833, interval 0.70 to 2.46.
TEST(PairedTGolden, StudentsSleep) {
  const std::vector<double> gained{1.2, 2.4, 1.3, 1.3, 0.0, 1.0, 1.8, 0.8, 4.6, 1.4};

  const PairedTest test = paired_t_test(gained);

  EXPECT_NEAR(test.mean, 1.58, 1e-12);
  EXPECT_NEAR(test.t, 4.0621, 5e-5);
  EXPECT_NEAR(test.p, 0.002833, 5e-7);
  EXPECT_NEAR(test.interval.low, 0.7001142, 5e-7);
  EXPECT_NEAR(test.interval.high, 2.4598858, 5e-7);
}

TEST(PairedT, NothingIsSaidOfOneDifference) {
  const std::vector<double> one{3.0};
  EXPECT_EQ(paired_t_test(one).p, 1.0);
  EXPECT_EQ(paired_t_test({}).p, 1.0);
}

TEST(Bootstrap, SameSeedSameInterval) {
  const std::vector<double> values{0.1, 0.5, 0.9, 0.3, 0.7};

  EXPECT_EQ(bootstrap_mean(values, 1, 3).low, bootstrap_mean(values, 1, 3).low);
  EXPECT_EQ(bootstrap_mean(values, 1, 3).high, bootstrap_mean(values, 1, 3).high);
}

TEST(Bootstrap, EveryGroupWeighsTheSame) {
  const std::vector<double> many(100, 1.0);
  const std::vector<double> few(2, 0.0);
  const std::vector<std::span<const double>> groups{many, few};

  const Interval interval = bootstrap_mean_of_means(groups, 1, 1);

  EXPECT_DOUBLE_EQ(interval.low, 0.5);
  EXPECT_DOUBLE_EQ(interval.high, 0.5);
}

}  // namespace
}  // namespace cgsr::lab
