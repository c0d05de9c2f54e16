// A boot that fails leaves nothing behind, wherever it fails.
#include "src/boot/boot_plan.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace cgsr::boot {
namespace {

constexpr int kSteps = 6;

std::string numbered(const std::string& word, int i) {
  return word + ' ' + std::to_string(i);
}

/// Steps that write down what is done to them; the one of number `failing` fails, -1: none.
void add_steps(BootPlan& plan, std::vector<std::string>& log, int failing) {
  for (int i = 0; i < kSteps; ++i) {
    BootStep step;
    step.name = std::to_string(i);
    if (i > 0) step.needs = {std::to_string(i - 1)};
    step.run = [&log, failing, i]() -> Result<void> {
      if (i == failing) return fail(numbered("failed", i));
      log.push_back(numbered("did", i));
      return {};
    };
    if (i != 2) step.undo = [&log, i] { log.push_back(numbered("undid", i)); };  // one has nothing to undo
    plan.add(step);
  }
}

/// The log of the first `count` steps, done and undone in reverse.
std::vector<std::string> there_and_back(int count) {
  std::vector<std::string> log;
  for (int i = 0; i < count; ++i) log.push_back(numbered("did", i));
  for (int i = count - 1; i >= 0; --i) {
    if (i != 2) log.push_back(numbered("undid", i));
  }
  return log;
}

TEST(BootPlanFault, WhereverItFailsTheStepsBeforeAreUndoneInReverse) {
  for (int failing = 0; failing < kSteps; ++failing) {
    std::vector<std::string> log;
    {
      BootPlan plan;
      add_steps(plan, log, failing);
      const auto booted = plan.run();
      ASSERT_FALSE(booted) << failing;
      EXPECT_EQ(booted.error().message, numbered("failed", failing));
      EXPECT_EQ(log, there_and_back(failing)) << failing << ": before the plan goes";
    }
    EXPECT_EQ(log, there_and_back(failing)) << failing << ": undone once";
  }
}

TEST(BootPlan, WhatSucceededStaysUntilThePlanGoes) {
  std::vector<std::string> log;
  {
    BootPlan plan;
    add_steps(plan, log, -1);
    ASSERT_TRUE(plan.run());
    EXPECT_EQ(log.size(), static_cast<std::size_t>(kSteps));
  }
  EXPECT_EQ(log, there_and_back(kSteps));
}

TEST(BootPlanFault, ACheckPassesByWhatNeedsTheStepThatFailed) {
  std::vector<std::string> log;
  {
    BootPlan plan;
    add_steps(plan, log, 3);
    const auto problems = plan.check();
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems.front().message, "failed 3");
  }
  EXPECT_EQ(log, there_and_back(3));
}

}  // namespace
}  // namespace cgsr::boot
