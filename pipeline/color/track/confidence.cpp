#include "pipeline/color/track/confidence.h"

#include <algorithm>
#include <cmath>

namespace cgsr::color {

double Confidence::add(const Evidence& evidence) {
  const ConfidenceParameters& p = parameters_;
  const std::array<double, kMeasures> measures{std::log(std::clamp(evidence.sharpness, 2.0, 60.0)), evidence.agreement,
                                               evidence.separation};
  const std::array<double, kMeasures> weights{p.sharpness_weight, p.agreement_weight, p.separation_weight};
  const double rate = measured_ ? p.smoothing : 1.0;
  measured_ = true;
  double log_odds = p.offset;
  for (std::size_t i = 0; i < kMeasures; ++i) {
    smoothed_[i] += rate * (measures[i] - smoothed_[i]);
    log_odds += weights[i] * smoothed_[i];
  }
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace cgsr::color
