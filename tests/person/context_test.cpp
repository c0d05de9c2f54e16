#include "pipeline/person/context.h"

#include <gtest/gtest.h>

namespace cgsr::person {
namespace {

TEST(Context, AnUndisturbedImageTakesNothingAway) {
  EXPECT_EQ(reliability(Cue::kColor, {}), 1.0);
  EXPECT_EQ(reliability(Cue::kGrey, {}), 1.0);
}

TEST(Context, DarknessCostsColorMoreAndBlurCostsGreyMore) {
  EXPECT_LT(reliability(Cue::kColor, {.dark = 0.5}), reliability(Cue::kGrey, {.dark = 0.5}));
  EXPECT_LT(reliability(Cue::kGrey, {.blurred = 0.5}), reliability(Cue::kColor, {.blurred = 0.5}));
}

TEST(Context, EveryDisturbanceLowersAndNoneRaises) {
  for (const Cue cue : {Cue::kColor, Cue::kGrey}) {
    for (double share = 0.0; share < 1.0; share += 0.1) {
      const double next = share + 0.1;
      EXPECT_LE(reliability(cue, {.dark = next}), reliability(cue, {.dark = share}));
      EXPECT_LE(reliability(cue, {.saturated = next}), reliability(cue, {.saturated = share}));
      EXPECT_LE(reliability(cue, {.blurred = next}), reliability(cue, {.blurred = share}));
    }
    const double worst = reliability(cue, {.dark = 1.0, .saturated = 1.0, .blurred = 1.0});
    EXPECT_GE(worst, 0.0);
    EXPECT_LT(worst, 0.2);
  }
}

}  // namespace
}  // namespace cgsr::person
