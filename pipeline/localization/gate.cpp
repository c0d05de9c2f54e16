#include "pipeline/localization/gate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace cgsr::localization {
namespace {

constexpr double kLeastSigma_m = 1e-4;
constexpr double kAsTheMap_m = 0.005;  // a pose as exact as a room's map

double worst_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
}

// Of the position, in its worst direction.
double position_sigma_m(const Estimate& estimate) {
  return std::max(kLeastSigma_m, worst_sigma(covariance_in_map(estimate).topLeftCorner<3, 3>()));
}

double log_odds(const Estimate& estimate, const Standing& standing, double sigma_m, const GateParameters& parameters) {
  return parameters.error_log_odds +
         parameters.error_per_lead * std::min(static_cast<double>(standing.lead), parameters.max_lead) +
         parameters.error_per_ln_cell * std::log(std::max(1.0, standing.cells)) +
         parameters.error_per_agreement * static_cast<double>(estimate.agreement_on_map) +
         parameters.error_per_ln_m * std::log(sigma_m) + parameters.error_per_px * estimate.solution.rms_px +
         parameters.error_per_ln_match * std::log(std::max(1, estimate.matches)) +
         parameters.error_per_cost * estimate.solution.cost;
}

// What would have to be better for a searched pose to be accepted.
Reason reason_of_refusal(const Estimate& estimate, const Standing& standing, const GateParameters& parameters) {
  const double sigma_m = position_sigma_m(estimate);
  const double most = parameters.max_error_log_odds;
  if (log_odds(estimate, standing, sigma_m, parameters) <= most) return Reason::kNone;
  Standing alone = standing;
  alone.lead = static_cast<float>(parameters.max_lead);
  if (log_odds(estimate, alone, sigma_m, parameters) <= most) return Reason::kAmbiguous;
  if (log_odds(estimate, standing, std::min(sigma_m, kAsTheMap_m), parameters) <= most) return Reason::kUncertain;
  return Reason::kUnexplained;
}

}  // namespace

geometry::Matrix6d covariance_in_map(const Estimate& estimate) {
  return estimate.solution.information.ldlt().solve(geometry::Matrix6d::Identity());
}

geometry::Matrix6d with_map_error(const geometry::Matrix6d& covariance_in_map, const LocalizerParameters& parameters) {
  geometry::Matrix6d covariance = covariance_in_map;
  covariance.topLeftCorner<3, 3>().diagonal().array() += parameters.map_sigma_m * parameters.map_sigma_m;
  return covariance;
}

bool same_answer(const geometry::Pose& a, const geometry::Pose& b, const GateParameters& parameters) {
  const geometry::Vector6d step = geometry::step_between(a, b);
  return step.head<3>().norm() <= parameters.same_m &&
         step.tail<3>().norm() <= parameters.same_deg * std::numbers::pi / 180.0;
}

float evidence_of(const Estimate& estimate, const Standing& standing, const GateParameters& parameters) {
  const float agreement = estimate.agreement_on_map;
  const float lead = std::min({standing.lead, static_cast<float>(parameters.max_lead),
                               agreement - static_cast<float>(parameters.chance_agreement)});
  return agreement + static_cast<float>(parameters.worst_part_weight) * estimate.agreement_in_the_worst + lead -
         static_cast<float>(parameters.prior_weight) * estimate.prior_chi2;
}

double log_odds_of_error(const Estimate& estimate, const Standing& standing, const GateParameters& parameters) {
  return log_odds(estimate, standing, position_sigma_m(estimate), parameters);
}

Reason gate(const Estimate& estimate, const std::optional<Standing>& standing, const geometry::Matrix6d& covariance,
            const LocalizerParameters& parameters) {
  const GateParameters& decision = parameters.decision;
  const bool narrow = !standing || standing->narrow;
  const int min_expected = narrow ? decision.min_tracking_expected : decision.min_expected;
  const int min_matches =
      narrow ? std::min(decision.min_tracking_expected, parameters.min_matches) : parameters.min_matches;
  if (estimate.expected < min_expected) return Reason::kNothingExpected;
  if (!estimate.solved || estimate.matches < min_matches) return Reason::kTooFewMatches;
  if (!standing && estimate.explained < parameters.min_tracking_matched_ratio) return Reason::kUnexplained;
  if (estimate.solution.rms_px > parameters.max_rms_px) return Reason::kResidual;
  if (estimate.prior_chi2 > parameters.max_prior_chi2) return Reason::kFarFromPrior;
  if (!standing) return Reason::kNone;
  if (standing->narrow && evidence_of(estimate, *standing, decision) < parameters.min_evidence) {
    const Standing alone{.lead = static_cast<float>(decision.max_lead)};
    return evidence_of(estimate, alone, decision) < parameters.min_evidence ? Reason::kUnexplained : Reason::kAmbiguous;
  }
  const double max_sigma_rad = parameters.max_sigma_deg * std::numbers::pi / 180.0;
  if (!(worst_sigma(covariance.topLeftCorner<3, 3>()) <= parameters.max_sigma_m) ||
      !(worst_sigma(covariance.bottomRightCorner<3, 3>()) <= max_sigma_rad))
    return Reason::kUncertain;
  if (!standing->narrow) return reason_of_refusal(estimate, *standing, decision);
  return Reason::kNone;
}

}  // namespace cgsr::localization
