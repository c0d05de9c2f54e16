#include "pipeline/color/search/divergence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

namespace cgsr::color {
namespace {

std::vector<double> random_histogram(std::mt19937& random, std::size_t bins) {
  std::vector<double> shares(bins);
  std::exponential_distribution<double> some(1.0);
  for (auto& share : shares) share = random() % 3 == 0 ? 0.0 : some(random);
  shares[random() % bins] += 0.1;
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (auto& share : shares) share /= sum;
  return shares;
}

double similarity(Divergence divergence, const std::vector<double>& p, const std::vector<double>& q) {
  double sum = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) sum += similarity_term(divergence, p[i], q[i]);
  return sum;
}

// Jensen-Shannon by its definition: half the two Kullback-Leibler divergences from the mean.
double jensen_shannon(const std::vector<double>& p, const std::vector<double>& q) {
  double sum = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double mean = (p[i] + q[i]) / 2;
    if (p[i] > 0) sum += p[i] * std::log(p[i] / mean) / 2;
    if (q[i] > 0) sum += q[i] * std::log(q[i] / mean) / 2;
  }
  return sum;
}

TEST(DivergenceProperty, IsWhatItsDefinitionSays) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 3000; ++trial) {
    const auto p = random_histogram(random, 20), q = random_histogram(random, 20);
    ASSERT_NEAR(divergence_of(Divergence::kJensenShannon, similarity(Divergence::kJensenShannon, p, q)),
                jensen_shannon(p, q), 1e-12);
    double coefficient = 0.0, intersection = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      coefficient += std::sqrt(p[i] * q[i]);
      intersection += std::min(p[i], q[i]);
    }
    ASSERT_NEAR(divergence_of(Divergence::kHellinger, similarity(Divergence::kHellinger, p, q)),
                std::sqrt(1 - coefficient), 1e-9);
    ASSERT_NEAR(divergence_of(Divergence::kIntersection, similarity(Divergence::kIntersection, p, q)), 1 - intersection,
                1e-12);
  }
}

TEST(DivergenceProperty, EqualHistogramsHaveNoneAndStrangersTheLargest) {
  std::mt19937 random(6);
  for (const auto& [name, divergence] : kDivergenceNames) {
    const auto p = random_histogram(random, 30);
    EXPECT_NEAR(divergence_of(divergence, similarity(divergence, p, p)), 0.0, 1e-7) << name;
    EXPECT_DOUBLE_EQ(divergence_of(divergence, similarity(divergence, {1.0, 0.0}, {0.0, 1.0})),
                     max_divergence(divergence))
        << name;
  }
  EXPECT_DOUBLE_EQ(max_divergence(Divergence::kJensenShannon), std::numbers::ln2);
}

// What the bounds of the search rest on.
TEST(DivergenceProperty, TermsRiseWithBothShares) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const auto& [name, divergence] : kDivergenceNames) {
    for (int trial = 0; trial < 3000; ++trial) {
      const double p = unit(random), q = unit(random), more = unit(random) * (1 - p);
      ASSERT_LE(similarity_term(divergence, p, q), similarity_term(divergence, p + more, q) + 1e-15) << name;
      ASSERT_NEAR(similarity_term(divergence, p, q), similarity_term(divergence, q, p), 1e-15) << name;
    }
  }
}

}  // namespace
}  // namespace cgsr::color
