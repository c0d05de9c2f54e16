#include "tools/lab/tracking/calibration.h"

#include <algorithm>
#include <cmath>

namespace cgsr::lab {

Calibration calibration_of(std::span<const Claim> claims) {
  Calibration result;
  result.claims = static_cast<int>(claims.size());
  for (const Claim& claim : claims) {
    const int number = std::clamp(static_cast<int>(claim.confidence * kConfidenceBins), 0, kConfidenceBins - 1);
    ReliabilityBin& bin = result.bins[static_cast<std::size_t>(number)];
    ++bin.claims;
    bin.mean_confidence += claim.confidence;
    bin.right += claim.right;
  }
  for (ReliabilityBin& bin : result.bins) {
    if (bin.claims == 0) continue;
    bin.mean_confidence /= bin.claims;
    bin.right /= bin.claims;
    result.error += std::abs(bin.mean_confidence - bin.right) * bin.claims / result.claims;
  }
  return result;
}

std::vector<Claim> claims_of(const TrackedRun& run, const Boxes& truth, double min_iou) {
  std::vector<Claim> claims;
  for (std::size_t i = 1; i < std::min(run.sightings.size(), truth.size()); ++i) {
    const Sighting& sighting = run.sightings[i];
    if (!sighting.box) continue;
    claims.push_back({sighting.confidence, truth[i] && score_image(*truth[i], sighting.box).iou >= min_iou});
  }
  return claims;
}

}  // namespace cgsr::lab
