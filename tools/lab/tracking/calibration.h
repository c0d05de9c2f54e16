#pragma once

#include <array>
#include <span>
#include <vector>

#include "tools/lab/scoring.h"
#include "tools/lab/tracking/runs.h"

namespace cgsr::lab {

/// A claim 'found' with its confidence, and whether it is right.
struct Claim {
  double confidence = 0.0;
  bool right = false;
};

inline constexpr int kConfidenceBins = 10;

struct ReliabilityBin {
  int claims = 0;
  double mean_confidence = 0.0;
  double right = 0.0;  ///< share
};

/// Reliability diagram in bins of equal width (Guo et al., ICML 2017, section 2).
struct Calibration {
  std::array<ReliabilityBin, kConfidenceBins> bins{};
  double error =
      0.0;  ///< expected calibration error: |mean confidence - share right|, averaged with the claims of each bin as weights.
  int claims = 0;
};

Calibration calibration_of(std::span<const Claim> claims);

/// The claims of a run without its start. \param min_iou  with the true box, from which a claim is right; one where the object is not
/// visible is wrong.
std::vector<Claim> claims_of(const TrackedRun& run, const Boxes& truth, double min_iou);

}  // namespace cgsr::lab
