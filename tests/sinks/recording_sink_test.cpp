#include "src/sinks/recording_sink.h"

#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"

namespace cgsr::sinks {
namespace {

TEST(RecordingSink, IsWrittenWhileNoImagesCome) {
  const test::ScratchFolder scratch;
  auto sink = RecordingSink::create(scratch / "outage.mcap");
  ASSERT_TRUE(sink) << sink.error().message;
  for (int cycle = 0; cycle < 3; ++cycle) ASSERT_TRUE((*sink)->on_control_cycle(MotionStatus{}));
  ASSERT_TRUE((*sink)->on_missing_image({}));
  Summary summary;
  (*sink)->summarize(summary);
  EXPECT_EQ(summary.json["recording"]["/cgsr/motion"]["written"], 3);
}

}  // namespace
}  // namespace cgsr::sinks
