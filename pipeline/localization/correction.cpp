#include "pipeline/localization/correction.h"

namespace cgsr::localization {

PriorSigmas PriorSigmas::times(double factor) const {
  return {.x_m = factor * x_m,
          .y_m = factor * y_m,
          .z_m = factor * z_m,
          .heading_rad = factor * heading_rad,
          .tilt_rad = factor * tilt_rad};
}

Prior prior_at(const geometry::Pose& X_WC, const PriorSigmas& sigmas) {
  geometry::Vector6d sigma;
  sigma << sigmas.x_m, sigmas.y_m, sigmas.z_m, sigmas.tilt_rad, sigmas.tilt_rad, sigmas.heading_rad;
  return {.X_WC = X_WC, .covariance = sigma.cwiseAbs2().asDiagonal()};
}

std::string_view to_string(Reason reason) {
  switch (reason) {
    case Reason::kNone:
      return "";
    case Reason::kSearching:
      return "searching";
    case Reason::kWrongSize:
      return "wrong_size";
    case Reason::kNoMap:
      return "no_map";
    case Reason::kTooDark:
      return "too_dark";
    case Reason::kTooBright:
      return "too_bright";
    case Reason::kTooFewEdges:
      return "too_few_edges";
    case Reason::kNothingExpected:
      return "nothing_expected";
    case Reason::kTooFewMatches:
      return "too_few_matches";
    case Reason::kUnexplained:
      return "unexplained";
    case Reason::kAmbiguous:
      return "ambiguous";
    case Reason::kFarFromPrior:
      return "far_from_prior";
    case Reason::kUncertain:
      return "uncertain";
    case Reason::kResidual:
      return "residual";
    case Reason::kBadPrior:
      return "bad_prior";
    case Reason::kNoBudget:
      return "no_budget";
  }
  return "";
}

}  // namespace cgsr::localization
