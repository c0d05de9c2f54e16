#include "hal/rmp/feedback_age.h"

#include <gtest/gtest.h>

namespace cgsr::hal::rmp {
namespace {

MonoTime ms(int count) {
  return MonoTime{std::chrono::milliseconds(count)};
}

void take_all_but(FeedbackAge& age, MessageId left_out, MonoTime stamp) {
  for (const auto id : FeedbackAge::kNeeded) {
    if (id != left_out) age.take(id, stamp);
  }
}

FeedbackAge age() {
  return FeedbackAge(seconds(0.030));
}

TEST(FeedbackAge, ASetIsWholeInAnyOrderAndWithRepetitions) {
  auto a = age();
  take_all_but(a, MessageId::kMotion, ms(10));
  take_all_but(a, MessageId::kMotion, ms(20));
  EXPECT_EQ(a.sets_in_a_row(), 0);
  EXPECT_FALSE(a.complete());
  EXPECT_FALSE(a.oldest(ms(30)));
  EXPECT_TRUE(a.take(MessageId::kMotion, ms(21)));
  EXPECT_EQ(a.sets_in_a_row(), 1);
  EXPECT_FALSE(a.take(MessageId::kMotion, ms(22))) << "the first of the next set";
}

TEST(FeedbackAge, TheOldestIsNamed) {
  auto a = age();
  take_all_but(a, MessageId::kBuild, ms(10));
  take_all_but(a, MessageId::kStatus, ms(20));
  const auto oldest = a.oldest(ms(45));
  ASSERT_TRUE(oldest);
  EXPECT_EQ(oldest->id, MessageId::kStatus);
  EXPECT_EQ(oldest->age, std::chrono::milliseconds(35));
}

TEST(FeedbackAge, AGapBreaksTheSeries) {
  auto a = age();
  for (int t = 10; t <= 50; t += 10) take_all_but(a, MessageId::kBuild, ms(t));
  EXPECT_EQ(a.sets_in_a_row(), 5);
  take_all_but(a, MessageId::kBuild, ms(80));
  EXPECT_EQ(a.sets_in_a_row(), 6) << "two lost sets are no gap";
  take_all_but(a, MessageId::kBuild, ms(111));
  EXPECT_EQ(a.sets_in_a_row(), 1);
}

TEST(FeedbackAge, WhatIsNotNeededChangesNothing) {
  auto a = age();
  EXPECT_FALSE(a.take(MessageId::kEcho, ms(10)));
  EXPECT_FALSE(a.take(MessageId::kWheelDistances, ms(10)));
  take_all_but(a, MessageId::kStatus, ms(10));
  EXPECT_FALSE(a.take(MessageId::kTorques, ms(10)));
  EXPECT_FALSE(a.complete());
}

}  // namespace
}  // namespace cgsr::hal::rmp
