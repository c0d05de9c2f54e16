#include "tools/lab/localization/odds_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace cgsr::lab {
namespace {

constexpr int kSteps = 50;
constexpr double kSettled = 1e-9;
constexpr double kRidge = 1.0;
constexpr double kLeastSigma_m = 1e-4;

double probability(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace

OddsTerms odds_terms(const localization::Correction& answer, const localization::GateParameters& parameters) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(answer.covariance.topLeftCorner<3, 3>(),
                                                            Eigen::EigenvaluesOnly);
  const double sigma_m = std::sqrt(std::max(0.0, axes.eigenvalues()[2]));
  OddsTerms terms;
  terms << 1.0, std::min(static_cast<double>(answer.lead), parameters.max_lead), std::log(std::max(1.0, answer.cells)),
      static_cast<double>(answer.agreement), std::log(std::max(kLeastSigma_m, sigma_m)),
      static_cast<double>(answer.rms_px), std::log(std::max(1, answer.matches)), answer.cost;
  return terms;
}

OddsTerms odds_weights(const localization::GateParameters& p) {
  OddsTerms weights;
  weights << p.error_log_odds, p.error_per_lead, p.error_per_ln_cell, p.error_per_agreement, p.error_per_ln_m,
      p.error_per_px, p.error_per_ln_match, p.error_per_cost;
  return weights;
}

OddsTerms fit_odds(std::span<const OddsSample> samples) {
  const auto wrong = std::count_if(samples.begin(), samples.end(), [](const OddsSample& s) { return s.wrong; });
  if (wrong == 0 || wrong == static_cast<std::ptrdiff_t>(samples.size())) return OddsTerms::Zero();
  const auto count = static_cast<double>(samples.size());
  OddsTerms mean = OddsTerms::Zero();
  for (const OddsSample& s : samples) mean += s.terms / count;
  OddsTerms deviation = OddsTerms::Zero();
  for (const OddsSample& s : samples) deviation += (s.terms - mean).cwiseAbs2() / count;
  deviation = deviation.cwiseSqrt().cwiseMax(1e-9);
  // The first term is 1 and stays so.
  mean[0] = 0.0;
  deviation[0] = 1.0;
  OddsTerms weights = OddsTerms::Zero();
  for (int step = 0; step < kSteps; ++step) {
    OddsTerms gradient = -kRidge * weights;
    Eigen::Matrix<double, OddsTerms::RowsAtCompileTime, OddsTerms::RowsAtCompileTime> hessian =
        kRidge * decltype(hessian)::Identity();
    gradient[0] = 0.0;
    hessian(0, 0) = 1e-9;
    for (const OddsSample& s : samples) {
      const OddsTerms x = (s.terms - mean).cwiseQuotient(deviation);
      const double p = probability(weights.dot(x));
      gradient += ((s.wrong ? 1.0 : 0.0) - p) * x;
      hessian += p * (1.0 - p) * x * x.transpose();
    }
    const OddsTerms change = hessian.ldlt().solve(gradient);
    weights += change;
    if (change.norm() < kSettled) break;
  }
  OddsTerms raw = weights.cwiseQuotient(deviation);
  raw[0] = weights[0] - raw.tail(raw.size() - 1).dot(mean.tail(mean.size() - 1));
  return raw;
}

double log_loss(std::span<const OddsSample> samples, const OddsTerms& weights) {
  double sum = 0.0;
  for (const OddsSample& s : samples) {
    const double odds = weights.dot(s.terms);
    sum += std::log1p(std::exp(s.wrong ? -odds : odds));
  }
  return samples.empty() ? 0.0 : sum / static_cast<double>(samples.size());
}

}  // namespace cgsr::lab
