#include "platform/message_rate.h"

#include <gtest/gtest.h>

namespace cgsr {
namespace {

MonoTime at(double s) {
  return MonoTime{seconds(s)};
}

TEST(MessageRate, LogsTheFirstAndAChangedOneOnlyAfterTheGap) {
  MessageRate rate(seconds(5.0));
  EXPECT_FALSE(rate.take("", at(0.0)));
  EXPECT_TRUE(rate.take("gone", at(1.0)));
  EXPECT_FALSE(rate.take("gone for 0.5 s", at(1.5)));
  EXPECT_TRUE(rate.take("gone for 5 s", at(6.0)));
  EXPECT_FALSE(rate.take("gone for 5 s", at(1000.0))) << "nothing new";
}

TEST(MessageRate, RepeatsTheSameWhereThatIsRequested) {
  MessageRate rate(seconds(5.0), seconds(60.0));
  EXPECT_TRUE(rate.take("no camera", at(0.0)));
  EXPECT_FALSE(rate.take("no camera", at(59.9)));
  EXPECT_TRUE(rate.take("no camera", at(60.0)));
  EXPECT_TRUE(rate.take("no bus", at(65.0)));
}

// Whatever comes and however fast: at most one line per gap.
TEST(MessageRate, IsBoundedForAnyStream) {
  MessageRate rate(seconds(5.0), seconds(60.0));
  int logged = 0;
  for (int i = 0; i < 10000; ++i) logged += rate.take(std::to_string(i), at(0.01 * i)) ? 1 : 0;
  EXPECT_EQ(logged, 20);
}

}  // namespace
}  // namespace cgsr
