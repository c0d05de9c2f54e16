#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tools/lab/scoring.h"

namespace cgsr::lab {

// Success and precision plots as the object tracking benchmark defines them (Wu, Lim and Yang, CVPR 2013), and what a robot needs besides:
// losses and wrong claims.

inline constexpr int kSuccessThresholds = 21;    ///< IoU 0, .05 .. 1
inline constexpr int kPrecisionThresholds = 51;  ///< 0 .. 50 px
inline constexpr double kPrecisionAt_px = 20.0;

/// A box below this IoU is off the object, as in the VOT challenge's definition of a failure (Kristan et al., 2020).
inline constexpr double kOffIou = 0.1;
/// An object that was lost is found again with a box of at least this IoU.
inline constexpr double kAgainIou = 0.3;

/// Shares of images, by threshold.
using SuccessCurve = std::array<double, kSuccessThresholds>;
using PrecisionCurve = std::array<double, kPrecisionThresholds>;

/// One run against the truth: shares and means are over the images in which the object is visible.
struct RunScore {
  SuccessCurve success{};      ///< images whose IoU is at least the threshold; at threshold 0: above it.
  PrecisionCurve precision{};  ///< images whose centre is at most so many pixels off.
  double auc = 0.0;            ///< the mean of `success`: 1 for the truth itself.
  double precision_20px = 0.0;
  Score boxes;  ///< precision (Eq. 3.2), recall, IoU, found.

  std::vector<int> losses;      ///< images in which the object is visible and the track leaves it: off, or not found.
  std::vector<int> recoveries;  ///< how many images each loss took that ended; fewer than losses: the others did not.
  int claims = 0;               ///< images with a box.
  int false_claims = 0;         ///< of these, those whose box is off the object, or where it is not visible.
  int images_without_object = 0;
  int claims_without_object = 0;
};

/// \param track  as long as the truth. Image 0, which is learned from, counts like any other.
RunScore score_run(const Boxes& track, const Boxes& truth);

/// The mean of many runs' curves and figures, every run counting the same; losses and claims are summed.
RunScore mean_score(std::span<const RunScore> runs);

}  // namespace cgsr::lab
