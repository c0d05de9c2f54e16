#include "pipeline/color/track/confidence.h"

#include <gtest/gtest.h>

namespace cgsr::color {
namespace {

constexpr Evidence kClear{30.0, 0.98, 0.4};

double first(const Evidence& evidence) {
  return Confidence{ConfidenceParameters{}}.add(evidence);
}

TEST(Confidence, IsAProbabilityForAnyMeasures) {
  for (const Evidence& evidence : {Evidence{}, Evidence{1e9, 1.0, 1.0}, Evidence{0.0, 0.0, -1.0}}) {
    EXPECT_GT(first(evidence), 0.0);
    EXPECT_LT(first(evidence), 1.0);
  }
}

TEST(Confidence, FallsWithEveryMeasureThatSpeaksAgainstTheObject) {
  EXPECT_GT(first(kClear), 0.8);
  for (int i = 0; i < 3; ++i) {
    Evidence worse = kClear;
    if (i == 0) worse.sharpness = 8.0;
    if (i == 1) worse.agreement = 0.5;
    if (i == 2) worse.separation = 0.0;
    EXPECT_LT(first(worse), first(kClear)) << i;
  }
}

TEST(Confidence, FollowsWhatIsSeenAndForgetsItAfterALoss) {
  constexpr Evidence kPoor{6.0, 0.5, 0.0};
  Confidence confidence{ConfidenceParameters{}};
  double last = confidence.add(kClear);
  for (int i = 0; i < 30; ++i) {
    const double now = confidence.add(kPoor);
    EXPECT_LT(now, last) << i;
    last = now;
  }
  EXPECT_NEAR(last, first(kPoor), 0.02);
  confidence.reset();
  EXPECT_EQ(confidence.add(kClear), first(kClear));
}

}  // namespace
}  // namespace cgsr::color
