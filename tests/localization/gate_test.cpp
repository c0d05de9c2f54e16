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

Reason judged(const Estimate& estimate, const std::optional<Standing>& standing = Standing{0.2F, 2.0}) {
  const LocalizerParameters parameters;
  return gate(estimate, standing, with_map_error(covariance_in_map(estimate), parameters), parameters);
}

TEST(Gate, LetsThroughWhatIsSure) {
  EXPECT_EQ(judged(good()), Reason::kNone);
}

TEST(Gate, DecidesByItsParameters) {
  const Estimate estimate = good();
  const geometry::Matrix6d covariance = covariance_in_map(estimate);
  const auto judged_by = [&](auto change) {
    LocalizerParameters parameters;
    change(parameters.decision);
    return gate(estimate, Standing{0.2F, 2.0}, covariance, parameters);
  };
  EXPECT_EQ(judged_by([](GateParameters&) {}), Reason::kNone);
  EXPECT_EQ(judged_by([](GateParameters& p) { p.min_expected = 21; }), Reason::kNothingExpected);
  EXPECT_EQ(judged_by([](GateParameters& p) { p.prior_weight = 0.5; }), Reason::kUnexplained);
  EXPECT_EQ(judged_by([](GateParameters& p) { p.max_sigma_ratio = 0.0; }), Reason::kUncertain);
}

TEST(Gate, AsksForMoreEvidenceTheWiderASearchedPoseIs) {
  const auto known_to = [](double sigma_m, float agreement) {
    Estimate estimate = good();
    estimate.agreement_on_map = agreement;
    estimate.solution.information(0, 0) = 1.0 / (sigma_m * sigma_m);
    return estimate;
  };
  const Standing just_ahead{0.06F, 2.0};
  EXPECT_EQ(judged(known_to(0.02, 0.45F), just_ahead), Reason::kNone);
  EXPECT_EQ(judged(known_to(0.06, 0.45F), just_ahead), Reason::kUncertain);
  EXPECT_EQ(judged(known_to(0.06, 0.8F), just_ahead), Reason::kNone);
  EXPECT_EQ(judged(known_to(0.15, 0.8F), just_ahead), Reason::kUncertain) << "whatever speaks for it";
  Standing few_starts = just_ahead;
  few_starts.narrow = true;
  EXPECT_EQ(judged(known_to(0.06, 0.45F), few_starts), Reason::kNone) << "the prior was right before";
}

// Nothing but the evidence says that it is the right one of several; how exact it is, its sigmas, its residual and its lead say.
TEST(Gate, RefusesASearchedPoseThatIsLikelyToBeOff) {
  Estimate estimate = good();
  estimate.agreement_on_map = 0.9F;
  estimate.solution.information = geometry::Matrix6d::Identity();
  estimate.solution.information.topLeftCorner<3, 3>() *= 1.0 / (0.04 * 0.04);
  estimate.solution.information.bottomRightCorner<3, 3>() *= 1.0 / (0.02 * 0.02);
  Standing standing{0.05F, 2.0};
  EXPECT_EQ(judged(estimate, standing), Reason::kUncertain);
  EXPECT_EQ(judged(estimate, std::nullopt), Reason::kNone) << "how uncertain a followed one may be is the tracker's";
  standing.narrow = true;
  EXPECT_EQ(judged(estimate, standing), Reason::kNone);
  const GateParameters parameters;
  const Standing wide{0.05F, 2.0};
  const double odds = log_odds_of_error(estimate, wide, parameters);
  EXPECT_GT(odds, parameters.max_error_log_odds);
  EXPECT_LT(log_odds_of_error(estimate, {0.25F, 2.0}, parameters), odds) << "ahead of all others";
  EXPECT_EQ(log_odds_of_error(estimate, {1.0F, 2.0}, parameters), log_odds_of_error(estimate, {0.3F, 2.0}, parameters))
      << "no lead counts for more than max_lead";
  Estimate closer = estimate;
  closer.solution.rms_px = 0.2;
  EXPECT_LT(log_odds_of_error(closer, wide, parameters), odds);
  Estimate surer = estimate;
  surer.solution.information *= 16.0;
  EXPECT_LT(log_odds_of_error(surer, wide, parameters), odds);
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
  EXPECT_EQ(judged(estimate), Reason::kUnexplained) << "no lead makes that enough";
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
  estimate.agreement_on_map = 0.45F;
  EXPECT_EQ(judged(estimate, Standing{0.001F, 2.0}), Reason::kAmbiguous);
  estimate = good();
  estimate.solution.information(0, 0) = 1.0;  // 1 m along x
  EXPECT_EQ(judged(estimate), Reason::kUncertain);
}

// A floor's tape that fits, and all that stands on it does not.
TEST(Gate, AsksWhetherImageAndMapAgreeEverywhere) {
  Estimate estimate = good();
  estimate.agreement_on_map = 0.45F;
  EXPECT_EQ(judged(estimate, Standing{0.1F, 2.0}), Reason::kNone);
  estimate.agreement_in_the_worst = 0.0F;
  EXPECT_NE(judged(estimate, Standing{0.1F, 2.0}), Reason::kNone);
}

// What is enough near a narrow prior is not enough far away in a wide one, where something always fits.
TEST(Gate, AsksForMoreWhereThereIsMoreToChooseFrom) {
  Estimate estimate = good();
  estimate.agreement_on_map = 0.5F;
  EXPECT_EQ(judged(estimate, Standing{0.1F, 1.0}), Reason::kNone);
  EXPECT_EQ(judged(estimate, Standing{0.1F, 20.0}), Reason::kAmbiguous);
  estimate.prior_chi2 = 16.0F;
  EXPECT_EQ(judged(estimate, Standing{0.1F, 1.0}), Reason::kAmbiguous);
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
