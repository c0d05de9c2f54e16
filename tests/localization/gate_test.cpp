#include "pipeline/localization/gate.h"

#include <optional>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

namespace cgsr::localization {
namespace {

Estimate good() {
  Estimate estimate;
  estimate.solved = true;
  estimate.expected = 20;
  estimate.matches = 15;
  estimate.explained = 0.8F;
  estimate.agreement_on_map = 0.7F;
  estimate.agreement_in_the_worst = 0.24F;
  estimate.prior_chi2 = 4.0F;
  estimate.solution.rms_px = 0.5;
  estimate.solution.information = geometry::Matrix6d::Identity() * 1e6;
  return estimate;
}

Reason judged(const Estimate& estimate, const std::optional<Standing>& standing = Standing{0.2F}) {
  const LocalizerParameters parameters;
  return gate(estimate, standing, with_map_error(covariance_in_map(estimate), parameters), parameters);
}

constexpr Standing kOfFew{.lead = 0.2F, .narrow = true};

TEST(Gate, LetsThroughWhatIsSure) {
  EXPECT_EQ(judged(good()), Reason::kNone);
  EXPECT_EQ(judged(good(), kOfFew), Reason::kNone);
}

TEST(Gate, DecidesByItsParameters) {
  const Estimate estimate = good();
  const geometry::Matrix6d covariance = covariance_in_map(estimate);
  const auto judged_by = [&](auto change, const Standing& standing = Standing{0.2F}) {
    LocalizerParameters parameters;
    change(parameters.decision);
    return gate(estimate, standing, covariance, parameters);
  };
  EXPECT_EQ(judged_by([](GateParameters&) {}), Reason::kNone);
  EXPECT_EQ(judged_by([](GateParameters& p) { p.min_expected = 21; }), Reason::kNothingExpected);
  EXPECT_EQ(judged_by([](GateParameters& p) { p.prior_weight = 0.5; }, kOfFew), Reason::kUnexplained);
  EXPECT_EQ(judged_by([](GateParameters& p) { p.prior_weight = 0.5; }), Reason::kNone) << "that of a narrow prior";
  EXPECT_EQ(judged_by([](GateParameters& p) { p.max_error_log_odds = -100.0; }), Reason::kUnexplained);
}

// Whatever makes a searched pose better makes an error less likely.
TEST(Gate, ASearchedPoseIsAcceptedByTheLogOddsOfItsError) {
  const GateParameters parameters;
  Estimate estimate = good();
  estimate.agreement_on_map = 0.5F;
  estimate.solution.information = geometry::Matrix6d::Identity() / (0.03 * 0.03);
  estimate.solution.rms_px = 0.6;
  estimate.matches = 10;
  estimate.solution.cost = 10.0;
  const Standing standing{0.05F};
  const double odds = log_odds_of_error(estimate, standing, parameters);
  ASSERT_GT(odds, parameters.max_error_log_odds);
  EXPECT_NE(judged(estimate, standing), Reason::kNone);
  EXPECT_EQ(judged(estimate, std::nullopt), Reason::kNone) << "how uncertain a followed one may be is the tracker's";
  EXPECT_LT(log_odds_of_error(estimate, {0.25F}, parameters), odds) << "ahead of all others";
  EXPECT_EQ(log_odds_of_error(estimate, {1.0F}, parameters), log_odds_of_error(estimate, {0.3F}, parameters))
      << "no lead counts for more than max_lead";
  const auto better = [&](auto change) {
    Estimate changed = estimate;
    change(changed);
    return log_odds_of_error(changed, standing, parameters);
  };
  EXPECT_LT(better([](Estimate& e) { e.agreement_on_map = 0.8F; }), odds);
  EXPECT_LT(better([](Estimate& e) { e.solution.information *= 16.0; }), odds);
  EXPECT_LT(better([](Estimate& e) { e.solution.rms_px = 0.2; }), odds);
  EXPECT_LT(better([](Estimate& e) { e.matches = 40; }), odds);
  EXPECT_LT(better([](Estimate& e) { e.solution.cost = 2.0; }), odds);
  EXPECT_LT(better([](Estimate&) {}), log_odds_of_error(estimate, {.lead = 0.05F, .cells = 50.0}, parameters))
      << "one of more poses";
}

TEST(Gate, NamesWhatIsMissing) {
  Estimate estimate = good();
  estimate.expected = 1;
  EXPECT_EQ(judged(estimate), Reason::kNothingExpected);
  estimate = good();
  estimate.matches = 2;
  EXPECT_EQ(judged(estimate), Reason::kTooFewMatches);
  estimate = good();
  estimate.solved = false;
  EXPECT_EQ(judged(estimate), Reason::kTooFewMatches);
  estimate = good();
  estimate.agreement_on_map = 0.1F;
  EXPECT_EQ(judged(estimate, kOfFew), Reason::kUnexplained) << "no lead makes that enough";
  estimate = good();
  estimate.explained = 0.2F;
  EXPECT_EQ(judged(estimate, std::nullopt), Reason::kUnexplained) << "the followed pose";
  estimate = good();
  estimate.solution.rms_px = 3.0;
  EXPECT_EQ(judged(estimate), Reason::kResidual);
  estimate = good();
  estimate.prior_chi2 = 30.0F;
  EXPECT_EQ(judged(estimate), Reason::kFarFromPrior);
  estimate = good();
  estimate.agreement_on_map = 0.4F;
  EXPECT_EQ(judged(estimate, Standing{.lead = 0.001F, .narrow = true}), Reason::kAmbiguous);
  estimate.solution.information = geometry::Matrix6d::Identity() / (0.03 * 0.03);
  EXPECT_EQ(judged(estimate, Standing{0.0F}), Reason::kAmbiguous);
  EXPECT_EQ(judged(estimate, Standing{0.3F}), Reason::kNone);
  estimate = good();
  estimate.solution.information(0, 0) = 1.0;  // 1 m along x
  EXPECT_EQ(judged(estimate), Reason::kUncertain);
  estimate = good();
  estimate.matches = 8;
  estimate.solution.information = geometry::Matrix6d::Identity() / (0.08 * 0.08);
  EXPECT_EQ(judged(estimate, Standing{0.3F}), Reason::kUncertain) << "exact to 8 cm";
  estimate.solution.information = geometry::Matrix6d::Identity() / (0.005 * 0.005);
  EXPECT_EQ(judged(estimate, Standing{0.3F}), Reason::kNone);
}

// A floor's tape that fits, and all that stands on it does not.
TEST(Gate, AsksWhetherImageAndMapAgreeEverywhere) {
  Estimate estimate = good();
  estimate.agreement_on_map = 0.4F;
  const Standing standing{.lead = 0.1F, .narrow = true};
  EXPECT_EQ(judged(estimate, standing), Reason::kNone);
  estimate.agreement_in_the_worst = 0.0F;
  EXPECT_NE(judged(estimate, standing), Reason::kNone);
}

// Who drives along a bare wall sees its skirting and no more: its distance is better than nothing, and the prior holds the rest.
TEST(Gate, AFollowedPoseNeedsLessThanOneThatWasSearched) {
  Estimate estimate = good();
  estimate.expected = 2;
  estimate.matches = 2;
  EXPECT_EQ(judged(estimate, std::nullopt), Reason::kNone);
  EXPECT_EQ(judged(estimate), Reason::kNothingExpected);
  estimate.matches = 1;
  EXPECT_EQ(judged(estimate, std::nullopt), Reason::kTooFewMatches);
}

TEST(Gate, CovarianceHoldsTheMapsOwnError) {
  LocalizerParameters parameters;
  parameters.map_sigma_m = 0.02;
  const geometry::Matrix6d covariance = with_map_error(covariance_in_map(good()), parameters);
  EXPECT_NEAR(covariance(0, 0), 1e-6 + 4e-4, 1e-12);
  EXPECT_NEAR(covariance(3, 3), 1e-6, 1e-12);
}

}  // namespace
}  // namespace cgsr::localization
