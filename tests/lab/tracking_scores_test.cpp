#include "tools/lab/tracking/scores.h"

#include <array>

#include <gtest/gtest.h>

#include "tools/lab/tracking/calibration.h"
#include "tools/lab/tracking/light_scores.h"
#include "tools/lab/tracking/robustness.h"

namespace cgsr::lab {
namespace {

Boxes still(int images) {
  return Boxes(static_cast<std::size_t>(images), Box{10, 20, 40, 30});
}

TEST(TrackingScores, TheTruthItselfIsPerfect) {
  const RunScore score = score_run(still(30), still(30));

  EXPECT_DOUBLE_EQ(score.auc, 1.0);
  EXPECT_DOUBLE_EQ(score.precision_20px, 1.0);
  EXPECT_DOUBLE_EQ(score.boxes.iou, 1.0);
  EXPECT_TRUE(score.losses.empty());
  EXPECT_EQ(score.false_claims, 0);
}

// A box of the same size moved by half its width shares 1/3: it passes the thresholds 0, .05 .. .30, which are 7 of 21.
TEST(TrackingScores, KnownBoxesHaveTheirCurve) {
  const Boxes track(10, Box{30, 20, 40, 30});
  const RunScore score = score_run(track, still(10));

  EXPECT_NEAR(score.boxes.iou, 1.0 / 3, 1e-12);
  EXPECT_NEAR(score.auc, 7.0 / 21, 1e-12);
  EXPECT_DOUBLE_EQ(score.success[6], 1.0);
  EXPECT_DOUBLE_EQ(score.success[7], 0.0);
  EXPECT_DOUBLE_EQ(score.precision[19], 0.0);
  EXPECT_DOUBLE_EQ(score.precision[20], 1.0);
}

TEST(TrackingScores, ALossEndsWhenTheObjectIsFoundAgain) {
  Boxes track = still(30);
  for (std::size_t i = 10; i < 14; ++i) track[i].reset();
  for (std::size_t i = 20; i < 30; ++i) track[i] = Box{300, 20, 40, 30};
  const RunScore score = score_run(track, still(30));

  EXPECT_EQ(score.losses, (std::vector{10, 20}));
  EXPECT_EQ(score.recoveries, (std::vector{4}));
  EXPECT_EQ(score.claims, 26);
  EXPECT_EQ(score.false_claims, 10);
}

TEST(TrackingScores, AClaimWhereTheObjectIsNotVisibleIsFalse) {
  Boxes truth = still(10);
  truth[5].reset();
  const RunScore score = score_run(still(10), truth);

  EXPECT_EQ(score.false_claims, 1);
  EXPECT_EQ(score.images_without_object, 1);
  EXPECT_EQ(score.boxes.images, 9);
}

TEST(RobustnessStarts, AreTwelveBoxesAroundTheFirst) {
  const auto starts = spatial_starts({100, 100, 40, 20}, {640, 480});

  ASSERT_EQ(starts.size(), 12U);
  for (const RunStart& start : starts) {
    EXPECT_EQ(start.image, 0);
    const double iou = score_image({100, 100, 40, 20}, start.box).iou;
    EXPECT_LT(iou, 1.0);
    EXPECT_GT(iou, 0.6);
  }
}

TEST(RobustnessStarts, AreSpreadOverTheVideoWhereTheObjectIsVisible) {
  Boxes truth = still(200);
  truth[50].reset();
  const auto starts = temporal_starts(truth, 20);

  EXPECT_EQ(starts.size(), 20U);
  EXPECT_EQ(starts[0].image, 0);
  EXPECT_EQ(starts[5].image, 51);
  EXPECT_EQ(starts[19].image, 190);
}

TEST(ConfidenceCalibration, ComparesWhatIsSaidWithWhatIsRight) {
  std::vector<Claim> claims;
  for (int i = 0; i < 100; ++i) claims.push_back({0.85, i < 65});
  const Calibration calibration = calibration_of(claims);

  EXPECT_NEAR(calibration.error, 0.2, 1e-12);
  EXPECT_EQ(calibration.bins[8].claims, 100);
  EXPECT_NEAR(calibration.bins[8].right, 0.65, 1e-12);
}

TEST(LightScores, ATrueEstimateHasNoErrorAndAFlatOneNoCorrelation) {
  std::vector<LightPair> exact, flat;
  for (int i = 0; i < 20; ++i) {
    const Light light{0.6 + 0.02 * i, 0.8, 1.0 - 0.02 * i};
    exact.push_back({light, light});
    flat.push_back({light, {0.8, 0.8, 0.8}});
  }

  EXPECT_NEAR(score_lights(exact).error, 0.0, 1e-12);
  EXPECT_NEAR(score_lights(exact).chroma_correlation, 1.0, 1e-9);
  EXPECT_GT(score_lights(flat).error, 0.05);
  EXPECT_EQ(score_lights(flat).chroma_correlation, 0.0);
}

// Estimates are absolute, the truth is relative to image 0: both have to agree when what was assumed at learning is divided out.
TEST(LightScores, EstimatesAreRelativeToWhatWasAssumedAtLearning) {
  const std::vector<std::optional<Light>> estimates{Light{0.8, 0.8, 1.0}, std::nullopt, Light{0.4, 0.8, 0.5}};
  const std::vector<std::optional<Light>> truth{Light{1, 1, 1}, Light{1, 1, 1}, Light{0.5, 1.0, 0.5}};

  const auto pairs = light_pairs(estimates, truth);

  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_NEAR(score_lights(pairs).error, 0.0, 1e-12);
}

}  // namespace
}  // namespace cgsr::lab
