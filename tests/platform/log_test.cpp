#include "platform/log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

namespace cgsr {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Log, WritesFromItsLevelOnToStandardError) {
  testing::internal::CaptureStderr();
  ASSERT_TRUE(set_up_log("warning"));
  spdlog::info("too quiet");
  spdlog::warn("camera: no image for {} ms", 250);
  const auto written = testing::internal::GetCapturedStderr();
  EXPECT_THAT(written, HasSubstr("warning camera: no image for 250 ms\n"));
  EXPECT_THAT(written, Not(HasSubstr("too quiet")));
}

TEST(Log, RefusesAWordThatIsNoLevel) {
  const auto outcome = set_up_log("loud");
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().message, "log level 'loud' is not one of trace, debug, info, warning, error, off");
}

}  // namespace
}  // namespace cgsr
