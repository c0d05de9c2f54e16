#include "pipeline/color/track/clutter.h"

#include <gtest/gtest.h>

namespace cgsr::color {
namespace {

constexpr ClutterParameters kParameters{1.5, 0.01, 1.0};
constexpr int kLongAgo = 20;  // images: more than are held back

TEST(Clutter, AsksWhatIsConfiguredBeforeAnythingWasLookedAt) {
  EXPECT_DOUBLE_EQ(Clutter(kParameters).min_log_odds(), 2.5);
}

TEST(Clutter, AsksForMoreThanTheStrongestThatOthersShowed) {
  Clutter clutter(kParameters);
  clutter.add(4.0);
  EXPECT_DOUBLE_EQ(clutter.min_log_odds(), 5.0);
  for (int i = 0; i < kLongAgo; ++i) clutter.add(-2.0);
  EXPECT_GT(clutter.min_log_odds(), 4.7);
  EXPECT_LE(clutter.min_log_odds(), 5.0);
}

TEST(Clutter, ForgetsSlowlyAndNotBelowWhatOthersShow) {
  Clutter clutter(kParameters);
  for (int i = 0; i < 100; ++i) clutter.add(-0.5);
  EXPECT_NEAR(clutter.min_log_odds(), 1.5, 1e-9);
  for (int i = 0; i < 1000; ++i) clutter.add(-0.5);
  EXPECT_NEAR(clutter.min_log_odds(), 0.5, 0.011);
  EXPECT_EQ(clutter.level(), 0.0) << "things that are no better than nothing";
}

TEST(Clutter, DoesNotCountTheObjectOnItsWayBack) {
  Clutter clutter(kParameters);
  const double before = clutter.min_log_odds();
  for (double log_odds : {0.5, 1.5, 3.0, 5.0}) clutter.add_pending(log_odds);
  EXPECT_LE(clutter.min_log_odds(), before) << "it may be the object";
  clutter.discard_pending();
  for (int i = 0; i < kLongAgo; ++i) clutter.add_pending(-2.0);
  EXPECT_LE(clutter.min_log_odds(), before) << "it was";
}

TEST(Clutter, CountsWhatWasNotTheObjectTenImagesLater) {
  Clutter clutter(kParameters);
  clutter.add_pending(3.0);
  for (int i = 0; i < 9; ++i) clutter.add_pending(-2.0);
  EXPECT_LE(clutter.min_log_odds(), 2.5);
  clutter.add_pending(-2.0);
  EXPECT_DOUBLE_EQ(clutter.min_log_odds(), 4.0);
}

TEST(Clutter, StartsAnewWhenReset) {
  Clutter clutter(kParameters);
  clutter.add(6.0);
  clutter.add_pending(5.0);
  clutter.reset();
  EXPECT_DOUBLE_EQ(clutter.min_log_odds(), 2.5);
  for (int i = 0; i < kLongAgo; ++i) clutter.add_pending(-2.0);
  EXPECT_LE(clutter.min_log_odds(), 2.5) << "nothing of before is counted later";
}

}  // namespace
}  // namespace cgsr::color
