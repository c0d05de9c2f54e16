#include "pipeline/localization/gate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace cgsr::localization {
namespace {

constexpr double kLeastSigma_m = 1e-4;
constexpr double kLeastSigma_deg = 1e-3;

double worst_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
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
         static_cast<float>(parameters.prior_weight) * estimate.prior_chi2 -
         static_cast<float>(parameters.choice_weight) * static_cast<float>(std::log(std::max(1.0, standing.cells)));
}

double log_odds_of_error(const Estimate& estimate, const Standing& standing, const GateParameters& parameters) {
  const geometry::Matrix6d covariance = covariance_in_map(estimate);
  const double sigma_m = std::max(kLeastSigma_m, worst_sigma(covariance.topLeftCorner<3, 3>()));
  const double sigma_deg =
      std::max(kLeastSigma_deg, worst_sigma(covariance.bottomRightCorner<3, 3>()) * 180.0 / std::numbers::pi);
  const double lead = std::min(static_cast<double>(standing.lead), parameters.max_lead);
  return parameters.error_log_odds + parameters.error_per_ln_m * std::log(sigma_m) +
         parameters.error_per_ln_deg * std::log(sigma_deg) + parameters.error_per_px * estimate.solution.rms_px -
         parameters.error_per_lead * lead;
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
  if (standing && evidence_of(estimate, *standing, decision) < parameters.min_evidence) {
    const Standing alone{.lead = static_cast<float>(decision.max_lead), .cells = standing->cells};
    return evidence_of(estimate, alone, decision) < parameters.min_evidence ? Reason::kUnexplained : Reason::kAmbiguous;
  }
  if (!standing) return Reason::kNone;
  double max_sigma_m = parameters.max_sigma_m;
  if (!standing->narrow) {
    // A wrong map has a pose that fits a few of its edges, and leaves open what they do: the less speaks for a searched pose, the surer it must be.
    const double more = static_cast<double>(evidence_of(estimate, *standing, decision)) - parameters.min_evidence;
    max_sigma_m *=
        std::min(decision.max_sigma_ratio, decision.min_sigma_ratio + decision.sigma_ratio_per_evidence * more);
  }
  const double max_sigma_rad = parameters.max_sigma_deg * std::numbers::pi / 180.0;
  if (!(worst_sigma(covariance.topLeftCorner<3, 3>()) <= max_sigma_m) ||
      !(worst_sigma(covariance.bottomRightCorner<3, 3>()) <= max_sigma_rad))
    return Reason::kUncertain;
  if (!standing->narrow && !(log_odds_of_error(estimate, *standing, decision) <= decision.max_error_log_odds))
    return Reason::kUncertain;
  return Reason::kNone;
}

}  // namespace cgsr::localization
