#include "pipeline/localization/search.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "tests/localization/random_numbers.h"

namespace cgsr::localization {
namespace {

TEST(SearchProperty, EvenNormalNumbersAreStandardNormalAndEven) {
  for (int dimension = 0; dimension < 6; ++dimension) {
    double sum = 0.0;
    double squares = 0.0;
    int below = 0;
    constexpr int kCount = 2000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const double z = even_normal(i, dimension);
      ASSERT_TRUE(std::isfinite(z));
      sum += z;
      squares += z * z;
      below += z < 1.0 ? 1 : 0;
    }
    EXPECT_NEAR(sum / kCount, 0.0, 0.03);
    EXPECT_NEAR(squares / kCount, 1.0, 0.03);
    EXPECT_NEAR(below / static_cast<double>(kCount), 0.8413, 0.005) << "much nearer than random draws would be";
  }
}

// The axes are a square root of the covariance, and each moves the image by what is said of it.
TEST(SearchProperty, AxesOfAPriorAreItsCovariance) {
  testing::RandomNumbers random(8);
  geometry::Matrix6d root;
  geometry::Matrix6d other;
  for (int i = 0; i < 36; ++i) {
    root(i / 6, i % 6) = random.normal();
    other(i / 6, i % 6) = random.normal();
  }
  const geometry::Matrix6d covariance = root * root.transpose();
  const geometry::Matrix6d metric = other * other.transpose();
  const PriorShape shape = PriorShape::of(covariance, metric);
  EXPECT_LT((shape.axes * shape.axes.transpose() - covariance).norm(), 1e-9 * covariance.norm());
  for (int i = 0; i < 6; ++i) {
    const geometry::Vector6d axis = shape.axes.col(i);
    EXPECT_NEAR(std::sqrt(axis.dot(metric * axis)), shape.motion_px[i], 1e-6);
  }
  EXPECT_DOUBLE_EQ(shape.widest_px(), shape.motion_px[0]);
}

// Of two poses that agree with the image alike the one whose matches fit better, or that is nearer to the prior, is the right one more often.
TEST(Search, ComparesPosesByAgreementAndHowWellTheirMatchesFit) {
  Estimate pose;
  pose.solved = true;
  pose.agreement = 0.5F;
  pose.matches = 10;
  pose.prior_chi2 = 2.0F;
  pose.solution.cost = 12.0;
  Estimate other = pose;
  other.solution.cost = 17.0;
  EXPECT_GT(search_rank(pose, 0.2), search_rank(other, 0.2));
  EXPECT_FLOAT_EQ(search_rank(pose, 0.0), search_rank(other, 0.0));
  other.agreement = 0.58F;
  EXPECT_LT(search_rank(pose, 0.15), search_rank(other, 0.15)) << "half a unit a match for eight hundredths";
  EXPECT_GT(search_rank(pose, 0.2), search_rank(other, 0.2));
  other = pose;
  other.matches = 20;
  other.solution.cost = 22.0;
  EXPECT_FLOAT_EQ(search_rank(pose, 0.2), search_rank(other, 0.2)) << "twice as many that fit as well";
  other = pose;
  other.prior_chi2 = 6.0F;
  other.solution.cost = 16.0;
  EXPECT_NEAR(search_rank(pose, 0.2) - search_rank(other, 0.2), 0.04, 1e-6) << "the prior counts once";
  other.solution.cost = 1e4;
  pose.solved = false;
  EXPECT_LT(search_rank(pose, 1.0), search_rank(other, 1.0));
}

}  // namespace
}  // namespace cgsr::localization
