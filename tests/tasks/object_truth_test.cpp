// Figures of a simulated run, on runs made by hand of which the figures are known.
#include "src/sinks/object_truth.h"

#include <gtest/gtest.h>

namespace cgsr::sinks::testing {
namespace {

constexpr double kSetDistance_m = 2.0;

/// A run image by image, 0.1 s apart.
class HandMadeRun {
 public:
  hal::ImageTruth truth;
  color::TrackedObject object;
  MotionStatus motion;

  HandMadeRun() {
    truth.there = true;
    truth.in_view = true;
    truth.distance_m = 3.0;
    truth.box = {10.0, 10.0, 20.0, 40.0};
    object.found = true;
    object.box = truth.box;
  }

  void images(int count) {
    for (int i = 0; i < count; ++i) {
      truth.stamp += seconds(0.1);
      tally_.add(truth, object, motion);
    }
  }
  void rolls(double forward_mps) {
    truth.robot_forward_mps = forward_mps;
    motion.commanded.forward_mps = forward_mps;
  }
  [[nodiscard]] const ObjectTruthStatistics& statistics() const { return tally_.statistics(); }

 private:
  ObjectTruth tally_{kSetDistance_m};
};

TEST(ObjectTruth, CountsFromTheFirstSightOn) {
  HandMadeRun run;
  run.object.found = false;
  run.images(5);
  EXPECT_EQ(run.statistics().images, 0u);
  run.object.found = true;
  run.images(3);
  run.truth.in_view = false;
  run.object.found = false;
  run.images(1);
  EXPECT_EQ(run.statistics().images, 4u);
  EXPECT_EQ(run.statistics().in_view, 3u);
  EXPECT_EQ(run.statistics().found, 3u);
}

TEST(ObjectTruth, WhatIsNotThereIsNotMissed) {
  HandMadeRun run;
  run.images(1);
  run.truth.there = run.truth.in_view = false;
  run.images(10);
  EXPECT_EQ(run.statistics().images, 1u);
  EXPECT_EQ(run.statistics().found_nothing, 10u);
}

TEST(ObjectTruth, ABoxElsewhereIsNotRight) {
  HandMadeRun run;
  run.images(1);
  run.object.box.x += 15.0;
  run.images(1);
  EXPECT_EQ(run.statistics().found, 2u);
  EXPECT_EQ(run.statistics().found_right, 1u);
}

TEST(ObjectTruth, NearestCountsOnlyWhatTheRobotDidItself) {
  HandMadeRun run;
  run.truth.distance_m = 1.0;
  run.images(1);  // stands
  EXPECT_FALSE(run.statistics().nearest_by_own_motion);
  run.rolls(0.3);
  run.truth.nearing_mps = 0.2;
  run.images(1);  // rolls, but the object comes too
  EXPECT_FALSE(run.statistics().nearest_by_own_motion);
  run.truth.nearing_mps = 0.0;
  run.truth.distance_m = 1.5;
  run.images(1);
  EXPECT_DOUBLE_EQ(*run.statistics().nearest_by_own_motion, 0.75);
  EXPECT_DOUBLE_EQ(run.statistics().min_distance_m, 1.0);
}

TEST(ObjectTruth, TakesTheTimeFromALossToZeroAndToStanding) {
  HandMadeRun run;
  run.rolls(0.3);
  run.images(2);
  run.truth.in_view = false;
  run.images(3);
  run.motion.commanded.forward_mps = 0.0;
  run.images(2);
  run.truth.robot_forward_mps = 0.04;
  run.images(5);
  EXPECT_EQ(run.statistics().losses, 1u);
  EXPECT_NEAR(*run.statistics().longest_command_after_loss_s, 0.3, 1e-9);
  EXPECT_NEAR(*run.statistics().longest_roll_after_loss_s, 0.5, 1e-9);
}

TEST(ObjectTruth, ALossWhileStandingNeedsNoStop) {
  HandMadeRun run;
  run.images(2);
  run.truth.in_view = false;
  run.images(20);
  EXPECT_EQ(run.statistics().losses, 0u);
  EXPECT_FALSE(run.statistics().longest_roll_after_loss_s);
}

TEST(ObjectTruth, TakesTheTimeFromANearingToZero) {
  HandMadeRun run;
  run.rolls(0.3);
  run.truth.nearing_mps = 0.4;
  run.images(2);  // nearer, but farther than the set distance
  EXPECT_EQ(run.statistics().nearings, 0u);
  run.truth.distance_m = 1.9;
  run.images(4);
  run.motion.commanded.forward_mps = 0.0;
  run.images(3);
  EXPECT_EQ(run.statistics().nearings, 1u);
  EXPECT_NEAR(*run.statistics().longest_command_when_nearer_s, 0.4, 1e-9);
}

}  // namespace
}  // namespace cgsr::sinks::testing
