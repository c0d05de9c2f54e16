#pragma once

#include <cstdint>
#include <string_view>

#include "pipeline/geometry/pose.h"

namespace cgsr::localization {

/// What is believed of the camera's pose before the image is looked at: X of Alg. 4.1, line 1, with its covariance.
struct Prior {
  geometry::Pose X_WC = geometry::Pose::Identity();
  geometry::Matrix6d covariance = geometry::Matrix6d::
      Zero();  ///< of the step geometry::moved() takes: metres and radians, axes of W. Positive definite.
};

/// Standard deviations of a prior in words that suit a robot.
struct PriorSigmas {
  double x_m = 0.15;
  double y_m = 0.15;
  double z_m = 0.15;
  double heading_rad = 0.0698;  ///< about W's z.
  double tilt_rad = 0.0175;     ///< about W's x and y, each.

  /// Robot on a level floor: height is known, roll and pitch nearly.
  static PriorSigmas floor() { return {.z_m = 0.01}; }
  /// Six free numbers.
  static PriorSigmas free() { return {}; }

  /// The same belief, so many times as uncertain.
  [[nodiscard]] PriorSigmas times(double factor) const;
};

/// \return a prior about X_WC whose errors are independent.
Prior prior_at(const geometry::Pose& X_WC, const PriorSigmas& sigmas);

/// Why a pose was not corrected; kNone: it was. Ours: Alg. 4.1 always corrects.
enum class Reason : std::uint8_t {
  kNone,
  kSearching,        ///< more starts are waiting: the next image goes on.
  kWrongSize,        ///< the image is neither the camera's size nor half of it, or of a format that is not read.
  kNoMap,            ///< the map has no edges.
  kTooDark,          ///< nearly black.
  kTooBright,        ///< saturated.
  kTooFewEdges,      ///< hardly a straight edge in the image: blur, a hand before the camera, a bare wall.
  kNothingExpected,  ///< the map shows next to nothing from here.
  kTooFewMatches,
  kUnexplained,  ///< too little of what is expected was found.
  kAmbiguous,    ///< another pose explains the image about as well.
  kFarFromPrior,
  kUncertain,  ///< the matches leave a direction open.
  kResidual,   ///< the matches do not fit together.
  kBadPrior,   ///< not finite, or its covariance is not positive definite.
  kNoBudget,   ///< not even one unit of work was granted.
};

/// \return the words of a CSV's `reason` column: lower_case, "" for kNone.
std::string_view to_string(Reason reason);

/// The answer to one image.
struct Correction {
  bool corrected = false;
  Reason reason = Reason::kNoBudget;
  geometry::Pose X_WC = geometry::Pose::Identity();  ///< not corrected: the prior's.
  /// Likewise; in the map as it is, which the next image sees again. Localizer::in_world adds the map's own error.
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  int matches = 0;         ///< pieces of edges that found a segment.
  float rms_px = 0.0F;     ///< of the distances d1 and d2, in pixels of the grey image that was worked on.
  float explained = 0.0F;  ///< share of the expected visible length that was found, 0..1.
  float lead = 0.0F;       ///< ahead of the second-best pose that differs, in agreement; 1 when no other was looked at.
  double cells = 1.0;      ///< how many poses that differ the prior holds; 1 when tracking.
  float agreement =
      0.0F;  ///< of image and map, 0..1: the length of edges that both hold over the length that either has.
  double cost =
      0.0;  ///< the solver's: robust squared distances in standard deviations and the prior's, summed, at X_WC with the stated noise.
  float error_log_odds =
      0.0F;  ///< that a searched pose is more than 5 cm or 1.5 degrees off (log_odds_of_error); 0 when tracking.
  float prior_chi2 = 0.0F;
  int segments = 0;  ///< perceived.
  int expected = 0;  ///< visible pieces of edges.
  int starts = 0;    ///< hypotheses scored so far in the search under way; 0 when tracking.
  int looks = 0;     ///< expectations drawn for this image.
};

}  // namespace cgsr::localization
