#include "tools/lab/localization/odds_fit.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/localization/gate.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {
namespace {

OddsTerms terms_of(Random& random) {
  OddsTerms terms;
  terms[0] = 1.0;
  for (Eigen::Index i = 1; i < terms.size(); ++i) terms[i] = 2.0 + 0.5 * static_cast<double>(i) * random.normal();
  return terms;
}

std::vector<OddsSample> drawn_from(const OddsTerms& weights, int count) {
  Random random(11);
  std::vector<OddsSample> samples;
  for (int i = 0; i < count; ++i) {
    OddsSample sample;
    sample.terms = terms_of(random);
    sample.wrong = random.chance(1.0 / (1.0 + std::exp(-weights.dot(sample.terms))));
    samples.push_back(sample);
  }
  return samples;
}

TEST(OddsFit, FindsTheWeightsThatWrongPosesWereDrawnFrom) {
  OddsTerms weights;
  weights << -1.0, 1.5, -0.8, 0.0, 0.6, -0.4, 0.3, 0.1;
  const auto samples = drawn_from(weights, 20000);
  const OddsTerms fitted = fit_odds(samples);
  for (Eigen::Index i = 0; i < weights.size(); ++i) EXPECT_NEAR(fitted[i], weights[i], i == 0 ? 0.4 : 0.1) << i;
  EXPECT_LE(log_loss(samples, fitted), log_loss(samples, weights) + 1e-6);
  EXPECT_LT(log_loss(samples, fitted), log_loss(samples, OddsTerms::Zero()));
}

TEST(OddsFit, NothingIsLearnedOfPosesThatAreAllRight) {
  std::vector<OddsSample> samples = drawn_from(OddsTerms::Zero(), 50);
  for (OddsSample& sample : samples) sample.wrong = false;
  EXPECT_EQ(fit_odds(samples), OddsTerms::Zero());
  EXPECT_EQ(fit_odds({}), OddsTerms::Zero());
}

// The table's terms and weights are the gate's own.
TEST(OddsFit, StatesWhatTheGateStates) {
  const localization::GateParameters parameters;
  localization::Estimate estimate;
  estimate.solved = true;
  estimate.agreement_on_map = 0.6F;
  estimate.matches = 17;
  estimate.solution.rms_px = 0.5;
  estimate.solution.cost = 9.0;
  geometry::Vector6d sigma;
  sigma << 0.02, 0.05, 0.01, 0.3, 0.4, 0.2;
  estimate.solution.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  const localization::Standing standing{.lead = 0.6F, .cells = 6.0};
  localization::Correction answer;
  answer.covariance = localization::covariance_in_map(estimate);
  answer.lead = standing.lead;
  answer.cells = standing.cells;
  answer.agreement = estimate.agreement_on_map;
  answer.matches = estimate.matches;
  answer.rms_px = 0.5F;
  answer.cost = estimate.solution.cost;
  EXPECT_NEAR(odds_weights(parameters).dot(odds_terms(answer, parameters)),
              localization::log_odds_of_error(estimate, standing, parameters), 1e-4);
}

}  // namespace
}  // namespace cgsr::lab
