#include "tools/lab/tracking/light_scores.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cgsr::lab {
namespace {

std::array<double, 2> chroma(const Light& light) {
  const double sum = light.r + light.g + light.b;
  return {light.r / sum, light.g / sum};
}

}  // namespace

LightScore score_lights(std::span<const LightPair> pairs) {
  LightScore score;
  score.images = static_cast<int>(pairs.size());
  if (pairs.empty()) return score;
  const auto count = static_cast<double>(pairs.size());
  std::array<double, 2> true_mean{}, estimated_mean{};
  for (const auto& [truth, estimate] : pairs) {
    score.error +=
        (std::abs(truth.r - estimate.r) + std::abs(truth.g - estimate.g) + std::abs(truth.b - estimate.b)) / 3 / count;
    for (std::size_t c = 0; c < 2; ++c) {
      true_mean[c] += chroma(truth)[c] / count;
      estimated_mean[c] += chroma(estimate)[c] / count;
    }
  }
  double both = 0.0, of_truth = 0.0, of_estimate = 0.0;
  for (const auto& [truth, estimate] : pairs) {
    for (std::size_t c = 0; c < 2; ++c) {
      const double t = chroma(truth)[c] - true_mean[c], e = chroma(estimate)[c] - estimated_mean[c];
      both += t * e;
      of_truth += t * t;
      of_estimate += e * e;
    }
  }
  constexpr double kConstant = 1e-12;
  if (of_truth > kConstant && of_estimate > kConstant)
    score.chroma_correlation = both / std::sqrt(of_truth * of_estimate);
  return score;
}

std::vector<LightPair> light_pairs(std::span<const std::optional<Light>> estimates,
                                   std::span<const std::optional<Light>> truth) {
  std::vector<LightPair> pairs;
  if (estimates.empty() || !estimates.front()) return pairs;
  const Light assumed = *estimates.front();
  for (std::size_t i = 1; i < std::min(estimates.size(), truth.size()); ++i) {
    if (!estimates[i] || !truth[i]) continue;
    const Light& light = *estimates[i];
    pairs.push_back({*truth[i], {light.r / assumed.r, light.g / assumed.g, light.b / assumed.b}});
  }
  return pairs;
}

}  // namespace cgsr::lab
