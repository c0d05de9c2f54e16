#include "pipeline/color/track/presence.h"

#include <algorithm>
#include <cmath>

namespace cgsr::color {

double Presence::log_odds(const PresenceMeasures& measures) const {
  constexpr double kLeastRatio = 0.02;
  const double score =
      std::log(std::clamp(measures.score_ratio, kLeastRatio, 1.0));  // more than usual proves nothing more
  const double sharpness = std::log(std::max(measures.sharpness, 1.0));
  return parameters_.offset + parameters_.score_weight * score + parameters_.sharpness_weight * sharpness +
         parameters_.divergence_weight * measures.divergence_rise + parameters_.separation_weight * measures.separation;
}

void Presence::add(double log_odds) {
  log_odds_ =
      std::clamp(parameters_.memory * log_odds_ + log_odds, -parameters_.max_log_odds, parameters_.max_log_odds);
}

}  // namespace cgsr::color
