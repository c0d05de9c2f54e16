#include "pipeline/behavior/ramp.h"

#include <gtest/gtest.h>

namespace cgsr::behavior {
namespace {

TEST(Ramp, RisesAndFallsAtTheirOwnRates) {
  EXPECT_DOUBLE_EQ(ramp(0.0, 1.0, 0.5, 2.0, 0.1), 0.05);
  EXPECT_DOUBLE_EQ(ramp(1.0, 0.0, 0.5, 2.0, 0.1), 0.8);
  EXPECT_DOUBLE_EQ(ramp(0.0, -1.0, 0.5, 2.0, 0.1), -0.05);
  EXPECT_DOUBLE_EQ(ramp(-1.0, 0.0, 0.5, 2.0, 0.1), -0.8);
}

TEST(Ramp, ArrivesExactly) {
  EXPECT_EQ(ramp(0.99, 1.0, 0.5, 2.0, 0.1), 1.0);
  EXPECT_EQ(ramp(0.1, 0.0, 0.5, 2.0, 0.1), 0.0);
  EXPECT_EQ(ramp(1.0, 1.0, 0.5, 2.0, 0.1), 1.0);
}

TEST(Ramp, PassesThroughZero) {
  EXPECT_DOUBLE_EQ(ramp(0.1, -1.0, 0.5, 0.5, 0.1), 0.05);
  EXPECT_DOUBLE_EQ(ramp(0.01, -1.0, 0.5, 0.5, 0.1), 0.0) << "and goes on in the next step";
  EXPECT_DOUBLE_EQ(ramp(0.0, -1.0, 0.5, 0.5, 0.1), -0.05);
}

TEST(Ramp, NoTimeNoChange) {
  EXPECT_EQ(ramp(0.3, 1.0, 0.5, 2.0, 0.0), 0.3);
}

}  // namespace
}  // namespace cgsr::behavior
