#include "platform/config/spelling.h"

#include <string>

#include <gtest/gtest.h>

namespace cgsr::config {
namespace {

TEST(Nearest, FindsSlipsOfTheFinger) {
  const std::vector<std::string_view> words{"budget_us", "every_frames", "phase", "skip"};
  EXPECT_EQ(nearest("budget_su", words), "budget_us") << "swapped";
  EXPECT_EQ(nearest("budgets_us", words), "budget_us") << "one too many";
  EXPECT_EQ(nearest("phse", words), "phase") << "one too few";
  EXPECT_EQ(nearest("phaze", words), "phase") << "another letter";
  EXPECT_EQ(nearest("every_frame", words), "every_frames");
}

TEST(Nearest, SaysNothingWhenNothingIsNear) {
  EXPECT_EQ(nearest("colour", {"budget_us", "skip"}), "");
  EXPECT_EQ(nearest("phone", {"phase", "skip"}), "") << "two letters of five are too many";
  EXPECT_EQ(nearest("", {"budget_us", "skip"}), "");
  EXPECT_EQ(nearest("budget_us", {}), "");
  EXPECT_EQ(nearest(std::string(60000, 'a'), {"budget_us"}), "");
}

}  // namespace
}  // namespace cgsr::config
