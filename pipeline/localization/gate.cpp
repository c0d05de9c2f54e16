#include "pipeline/localization/gate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace cgsr::localization {
namespace {

constexpr float kMostExplained = 1.1F;
constexpr float kMostLead = 0.5F;
constexpr float kLeadCounts = 0.5F;
constexpr float kPriorCounts = 0.01F;
constexpr int kLeastExpected = 3;
constexpr float kLeadMatches = 0.5F;  // of one match's share of what is explained

double worst_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
}

}  // namespace

geometry::Matrix6d covariance_of(const Estimate& estimate, const LocalizerParameters& parameters) {
  geometry::Matrix6d covariance = estimate.solution.information.ldlt().solve(geometry::Matrix6d::Identity());
  covariance.topLeftCorner<3, 3>().diagonal().array() += parameters.map_sigma_m * parameters.map_sigma_m;
  return covariance;
}

float evidence_of(const Estimate& estimate, float lead) {
  return std::min(estimate.explained, kMostExplained) + kLeadCounts * std::min(lead, kMostLead) -
         kPriorCounts * estimate.prior_chi2;
}

Reason gate(const Estimate& estimate, float lead, const geometry::Matrix6d& covariance,
            const LocalizerParameters& parameters) {
  if (estimate.expected < kLeastExpected) return Reason::kNothingExpected;
  if (!estimate.solved || estimate.matches < parameters.matches_least) return Reason::kTooFewMatches;
  if (estimate.explained < parameters.explained_least) return Reason::kUnexplained;
  if (estimate.solution.rms_px > parameters.rms_most_px) return Reason::kResidual;
  if (estimate.prior_chi2 > parameters.prior_chi2_most) return Reason::kFarFromPrior;
  // A single match more or less must not decide: with few of them the lead has to be larger.
  const float lead_of_a_match = kLeadMatches / static_cast<float>(estimate.matches);
  if (lead < std::max(static_cast<float>(parameters.lead_least), lead_of_a_match)) return Reason::kAmbiguous;
  if (evidence_of(estimate, lead) < parameters.evidence_least) return Reason::kAmbiguous;
  const double turn_most = parameters.sigma_most_deg * std::numbers::pi / 180.0;
  if (!(worst_sigma(covariance.topLeftCorner<3, 3>()) <= parameters.sigma_most_m) ||
      !(worst_sigma(covariance.bottomRightCorner<3, 3>()) <= turn_most))
    return Reason::kUncertain;
  return Reason::kNone;
}

}  // namespace cgsr::localization
