#include "pipeline/localization/gate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace cgsr::localization {
namespace {

constexpr float kMostLead = 0.3F;  // ahead of a pose that has next to nothing: more of it says no more
// Agreement that some pose always has: where no alternative hypothesis was found it is the alternative hypothesis.
constexpr float kChance = 0.2F;
constexpr float kWorstCounts = 0.5F;   // of a room's pose that is right in one corner only the others tell
constexpr float kPriorCounts = 0.02F;  // of a squared sigma from the prior: the farther off, the more must speak for it
constexpr float kChoiceCounts =
    0.08F;  // of the logarithm of the number of poses there are: the best of them by chance grows with it
// A wrong map has a pose that fits a few of its edges, and leaves open what they do: with the least evidence a searched pose must be this
// much surer than max_sigma_m; the more speaks for it, the less.
constexpr double kSureShare = 0.3;
constexpr double kSurePerEvidence = 2.5;
constexpr double kSureMost = 1.2;
constexpr double kSame_m = 0.05;
constexpr double kSame_rad = 1.5 * std::numbers::pi / 180.0;
constexpr int kLeastExpected = 3;
// Where a narrow prior holds what they leave open: a bare wall shows its skirting, and that says how far it is.
constexpr int kLeastFollowed = 2;

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

bool same_answer(const geometry::Pose& a, const geometry::Pose& b) {
  const geometry::Vector6d step = geometry::step_between(a, b);
  return step.head<3>().norm() <= kSame_m && step.tail<3>().norm() <= kSame_rad;
}

float evidence_of(const Estimate& estimate, const Standing& standing) {
  const float agreement = estimate.agreement_on_map;
  const float lead = std::min({standing.lead, kMostLead, agreement - kChance});
  return agreement + kWorstCounts * estimate.agreement_in_the_worst + lead - kPriorCounts * estimate.prior_chi2 -
         kChoiceCounts * static_cast<float>(std::log(std::max(1.0, standing.cells)));
}

Reason gate(const Estimate& estimate, const std::optional<Standing>& standing, const geometry::Matrix6d& covariance,
            const LocalizerParameters& parameters) {
  const bool narrow = !standing || standing->narrow;
  const int min_expected = narrow ? kLeastFollowed : kLeastExpected;
  const int min_matches = narrow ? std::min(kLeastFollowed, parameters.min_matches) : parameters.min_matches;
  if (estimate.expected < min_expected) return Reason::kNothingExpected;
  if (!estimate.solved || estimate.matches < min_matches) return Reason::kTooFewMatches;
  if (!standing && estimate.explained < parameters.min_tracking_matched_ratio) return Reason::kUnexplained;
  if (estimate.solution.rms_px > parameters.max_rms_px) return Reason::kResidual;
  if (estimate.prior_chi2 > parameters.max_prior_chi2) return Reason::kFarFromPrior;
  if (standing && evidence_of(estimate, *standing) < parameters.min_evidence) {
    const Standing alone{.lead = kMostLead, .cells = standing->cells};
    return evidence_of(estimate, alone) < parameters.min_evidence ? Reason::kUnexplained : Reason::kAmbiguous;
  }
  if (!standing) return Reason::kNone;
  double place_most_m = parameters.max_sigma_m;
  if (!standing->narrow) {
    const double more = static_cast<double>(evidence_of(estimate, *standing)) - parameters.min_evidence;
    place_most_m *= std::min(kSureMost, kSureShare + kSurePerEvidence * more);
  }
  const double max_turn = parameters.max_sigma_deg * std::numbers::pi / 180.0;
  if (!(worst_sigma(covariance.topLeftCorner<3, 3>()) <= place_most_m) ||
      !(worst_sigma(covariance.bottomRightCorner<3, 3>()) <= max_turn))
    return Reason::kUncertain;
  return Reason::kNone;
}

}  // namespace cgsr::localization
