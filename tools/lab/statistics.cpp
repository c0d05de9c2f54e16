#include "tools/lab/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "tools/lab/scenes/random.h"

namespace cgsr::lab {
namespace {

constexpr int kDraws = 2000;
constexpr double kZ95 = 1.959963984540054;  // quantile 0.975 of the normal distribution

/// Mean of one draw with replacement: whole blocks, each started anywhere and wrapped at the end, until there are enough values.
double resampled_mean(std::span<const double> values, int block, Random& random) {
  const auto count = static_cast<int>(values.size());
  double sum = 0.0;
  for (int taken = 0; taken < count;) {
    const int start = random.below(count);
    for (int i = 0; i < block && taken < count; ++i, ++taken) {
      sum += values[static_cast<std::size_t>((start + i) % count)];
    }
  }
  return sum / count;
}

/// The regularised incomplete beta function by its continued fraction (Press et al., Numerical Recipes, 6.4).
double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - incomplete_beta(b, a, 1.0 - x);
  constexpr double kTiny = 1e-300;
  double c = 1.0;
  double d = 1.0 - (a + b) * x / (a + 1.0);
  d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
  double h = d;
  for (int m = 1; m <= 300; ++m) {
    double step = 1.0;
    for (const double term : {m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m)),
                              -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))}) {
      d = 1.0 + term * d;
      d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
      c = 1.0 + term / c;
      if (std::abs(c) < kTiny) c = kTiny;
      step = c * d;
      h *= step;
    }
    if (std::abs(step - 1.0) < 1e-14) break;
  }
  return front * h / a;
}

/// How likely Student's t is at least this far from 0, either way.
double both_tails(double t, double freedom) {
  return incomplete_beta(freedom / 2.0, 0.5, freedom / (freedom + t * t));
}

}  // namespace

PairedTest paired_t_test(std::span<const double> differences) {
  PairedTest test;
  const auto n = static_cast<double>(differences.size());
  if (differences.size() < 2) return test;
  test.mean = mean(differences);
  double squares = 0.0;
  for (const double d : differences) squares += (d - test.mean) * (d - test.mean);
  const double error = std::sqrt(squares / (n - 1.0) / n);
  double low = 0.0;
  double high = 13.0;  // the quantile of one degree of freedom is 12.7
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2.0;
    (both_tails(middle, n - 1.0) > 0.05 ? low : high) = middle;
  }
  test.interval = {test.mean - low * error, test.mean + low * error};
  if (error > 0.0) {
    test.t = test.mean / error;
    test.p = both_tails(test.t, n - 1.0);
  }
  return test;
}

Interval wilson(int successes, int trials) {
  if (trials <= 0) return {0.0, 1.0};
  const double n = trials;
  const double share = successes / n;
  const double centre = share + kZ95 * kZ95 / (2 * n);
  const double half = kZ95 * std::sqrt(share * (1 - share) / n + kZ95 * kZ95 / (4 * n * n));
  const double scale = 1 + kZ95 * kZ95 / n;
  return {std::max(0.0, (centre - half) / scale), std::min(1.0, (centre + half) / scale)};
}

Interval bootstrap_mean(std::span<const double> values, int block, std::uint64_t seed) {
  return bootstrap_mean_of_means(std::span(&values, 1), block, seed);
}

Interval bootstrap_mean_of_means(std::span<const std::span<const double>> groups, int block, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> means;
  for (int draw = 0; draw < kDraws; ++draw) {
    double sum = 0.0;
    int used = 0;
    for (const auto& group : groups) {
      if (group.empty()) continue;
      sum += resampled_mean(group, std::max(block, 1), random);
      ++used;
    }
    means.push_back(used > 0 ? sum / used : 0.0);
  }
  std::ranges::sort(means);
  return {means[kDraws / 40], means[kDraws - 1 - kDraws / 40]};
}

double mean(std::span<const double> values) {
  if (values.empty()) return 0.0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double quantile(std::span<const double> values, double share) {
  if (values.empty()) return 0.0;
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  const auto count = static_cast<double>(sorted.size());
  const auto rank = static_cast<std::size_t>(std::max(0.0, std::ceil(share * count) - 1.0));
  return sorted[std::min(sorted.size() - 1, rank)];
}

Interval quantile_interval(std::span<const double> values, double share) {
  if (values.empty()) return {};
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  const auto count = static_cast<double>(sorted.size());
  const double spread = kZ95 * std::sqrt(count * share * (1.0 - share));
  const double low = std::clamp(std::floor(share * count - spread) - 1.0, 0.0, count - 1.0);
  const double high = std::clamp(std::ceil(share * count + spread), 0.0, count - 1.0);
  return {sorted[static_cast<std::size_t>(low)], sorted[static_cast<std::size_t>(high)]};
}

}  // namespace cgsr::lab
