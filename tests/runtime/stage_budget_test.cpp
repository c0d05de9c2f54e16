#include "pipeline/runtime/stage_budget.h"

#include <gtest/gtest.h>

namespace cgsr::runtime {
namespace {

using std::chrono::microseconds;

constexpr MonoTime at_us(int us) {
  return MonoTime{microseconds(us)};
}

TEST(StageBudget, GrantsItsUnitsAndNoMore) {
  auto budget = StageBudget::of_units(3);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(budget.grant());
  EXPECT_FALSE(budget.refused());
  EXPECT_FALSE(budget.grant());
  EXPECT_FALSE(budget.grant());
  EXPECT_EQ(budget.granted(), 3U);
  EXPECT_TRUE(budget.refused());
}

TEST(StageBudget, OfNoUnitsRefusesAtOnce) {
  auto budget = StageBudget::of_units(0);
  EXPECT_FALSE(budget.grant());
  EXPECT_TRUE(budget.refused());
}

TEST(StageBudget, StopsBeforeTheUnitThatWouldNotFit) {
  SimulatedClock clock;
  auto budget = StageBudget::until(clock, at_us(1000));
  int units = 0;
  while (budget.grant()) {
    clock.advance(microseconds(300));
    ++units;
  }
  EXPECT_EQ(units, 3);  // the fourth would have ended at 1200
  EXPECT_EQ(clock.now(), at_us(900));
}

TEST(StageBudget, ExpectsTheLongestUnitSoFar) {
  SimulatedClock clock;
  auto budget = StageBudget::until(clock, at_us(1000));
  EXPECT_TRUE(budget.grant());
  clock.advance(microseconds(400));
  EXPECT_TRUE(budget.grant());
  clock.advance(microseconds(250));
  EXPECT_FALSE(budget.grant());  // at 650 another 400 would end at 1050
}

TEST(StageBudget, OnceRefusedStaysRefused) {
  SimulatedClock clock(at_us(1000));
  auto budget = StageBudget::until(clock, at_us(1000));
  EXPECT_FALSE(budget.grant());
  EXPECT_FALSE(budget.grant());
  EXPECT_EQ(budget.granted(), 0U);
}

// Through the interface that chapters know.
TEST(StageBudget, IsAWorkBudget) {
  auto budget = StageBudget::of_units(1);
  WorkBudget& asked = budget;
  EXPECT_TRUE(asked.grant());
  EXPECT_FALSE(asked.grant());
}

}  // namespace
}  // namespace cgsr::runtime
