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

}  // namespace

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

}  // namespace cgsr::lab
