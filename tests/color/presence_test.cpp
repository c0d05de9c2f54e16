#include "pipeline/color/track/presence.h"

#include <cmath>

#include <gtest/gtest.h>

namespace cgsr::color {
namespace {

constexpr PresenceMeasures kSeen{1.0, 25.0, 0.0, 0.3};
constexpr PresenceMeasures kWeak{0.9, 8.0, 0.05, 0.1};   // blurred, or half covered
constexpr PresenceMeasures kGone{0.5, 5.5, 0.15, 0.05};  // noise: the highest of no response at all

double log_odds(const PresenceMeasures& measures) {
  return Presence{PresenceParameters{}}.log_odds(measures);
}

TEST(Presence, EveryMeasureThatGetsWorseSpeaksAgainstTheObject) {
  for (int i = 0; i < 4; ++i) {
    PresenceMeasures worse = kSeen;
    if (i == 0) worse.score_ratio = 0.5;
    if (i == 1) worse.sharpness = 8.0;
    if (i == 2) worse.divergence_rise = 0.2;
    if (i == 3) worse.separation = 0.0;
    EXPECT_LT(log_odds(worse), log_odds(kSeen)) << i;
  }
}

TEST(Presence, AScoreAboveTheUsualProvesNothingMore) {
  PresenceMeasures higher = kSeen;
  higher.score_ratio = 3.0;
  EXPECT_EQ(log_odds(higher), log_odds(kSeen));
}

TEST(Presence, IsFiniteForAnyMeasures) {
  for (const PresenceMeasures& measures :
       {PresenceMeasures{}, PresenceMeasures{-1.0, -1.0, 0.7, -1.0}, PresenceMeasures{1e9, 1e9, -0.7, 1.0}}) {
    EXPECT_TRUE(std::isfinite(log_odds(measures)));
  }
}

TEST(Presence, EndsWithTheFirstImageThatHasNoSignOfTheObject) {
  Presence presence{PresenceParameters{}};
  presence.confirm();
  presence.add(presence.log_odds(kSeen));
  EXPECT_TRUE(presence.believed());
  presence.add(presence.log_odds(kGone));
  EXPECT_FALSE(presence.believed());
}

TEST(Presence, OutlastsOneWeakImageButNotMany) {
  Presence presence{PresenceParameters{}};
  presence.confirm();
  presence.add(presence.log_odds(kWeak));
  EXPECT_TRUE(presence.believed());
  for (int i = 0; i < 8; ++i) presence.add(presence.log_odds(kWeak));
  EXPECT_FALSE(presence.believed());
}

TEST(Presence, ComesBackWithAClearImageAfterAnyNumberWithoutTheObject) {
  Presence presence{PresenceParameters{}};
  for (int i = 0; i < 100; ++i) presence.add(presence.log_odds(kGone));
  presence.add(presence.log_odds(kSeen));
  EXPECT_TRUE(presence.believed());
  presence.deny();
  EXPECT_FALSE(presence.believed());
}

}  // namespace
}  // namespace cgsr::color
