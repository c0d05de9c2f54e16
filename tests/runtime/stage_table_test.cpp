#include "pipeline/runtime/stage_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/runtime/stage_test_support.h"

namespace cgsr::runtime {
namespace {

using std::chrono::microseconds;

FrameRecord frame_of(Duration track, Duration decide) {
  FrameRecord record;
  record.frame = 1;
  record.has_image = true;
  record.stage_count = 2;
  record.finished = record.started + track + decide;
  record.stages[0] = {track.count(), 0, StageOutcome::kRan, false, false};
  record.stages[1] = {decide.count(), 0, StageOutcome::kRan, false, false};
  return record;
}

class StageTableTest : public testing::Test {
 protected:
  StageTable table{schedule_of({stage_row("track", 1, 0, 7000), stage_row("decide", 1, 0, 500)})};
};

TEST_F(StageTableTest, SumsWhatTheRecordsSay) {
  for (int i = 0; i < 99; ++i) table.add(frame_of(microseconds(1000), microseconds(100)));
  auto slow = frame_of(microseconds(8000), microseconds(100));
  slow.stages[0].overran = true;
  slow.stages[0].refused = true;
  slow.late = true;
  table.add(slow);
  auto skipped = frame_of({}, microseconds(100));
  skipped.stages[0] = {0, 0, StageOutcome::kSkipped, false, false};
  table.add(skipped);
  auto faulted = frame_of(microseconds(500), microseconds(100));
  faulted.stages[0].outcome = StageOutcome::kFaulted;
  faulted.has_image = false;
  table.add(faulted);

  const auto stages = table.stages();
  ASSERT_EQ(stages.size(), 2U);
  EXPECT_EQ(stages[0].name, "track");
  EXPECT_EQ(stages[0].budget_us, 7000);
  EXPECT_EQ(stages[0].runs, 101U);
  EXPECT_EQ(stages[0].skips, 1U);
  EXPECT_EQ(stages[0].overruns, 1U);
  EXPECT_EQ(stages[0].refusals, 1U);
  EXPECT_EQ(stages[0].faults, 1U);
  EXPECT_NEAR(stages[0].mean_us, (99 * 1000.0 + 8000.0 + 500.0) / 101.0, 0.01);
  EXPECT_GE(stages[0].p99_us, 1000.0);
  EXPECT_LE(stages[0].p99_us, 1063.0);
  EXPECT_EQ(stages[0].worst_us, 8000.0);
  EXPECT_EQ(stages[1].runs, 102U);
  EXPECT_EQ(table.frames().frames, 102U);
  EXPECT_EQ(table.frames().late, 1U);
  EXPECT_EQ(table.frames().without_image, 1U);
  EXPECT_EQ(table.frames().worst_us, 8100.0);
}

TEST_F(StageTableTest, LeavesTheWarmUpOut) {
  auto record = frame_of(microseconds(90'000), microseconds(100));
  record.warm_up = true;
  table.add(record);
  EXPECT_EQ(table.frames().frames, 0U);
  EXPECT_EQ(table.stages()[0].runs, 0U);
}

TEST_F(StageTableTest, PrintsALinePerStage) {
  auto record = frame_of(microseconds(7400), microseconds(120));
  record.stages[0].overran = true;
  table.add(record);
  auto skipped = frame_of({}, microseconds(80));
  skipped.stages[0] = {0, 0, StageOutcome::kSkipped, false, false};
  table.add(skipped);
  EXPECT_EQ(to_text(table),
            "stage                runs   skips overruns  faults budget/µs   mean/µs    p99/µs  worst/µs\n"
            "track                   1       1        1       0      7000      7400      7400      7400\n"
            "decide                  2       0        0       0       500       100       120       120\n"
            "whole frame             2                                         3800      7520      7520\n"
            "0 frames took longer than the time between two images, 0 ran without an image\n");
}

// A record of a longer schedule, as a damaged recording might hold, adds what the table has rows for.
TEST_F(StageTableTest, SurvivesARecordWithMoreStages) {
  auto record = frame_of(microseconds(1), microseconds(1));
  record.stage_count = 4'000'000'000U;
  table.add(record);
  EXPECT_EQ(table.stages()[1].runs, 1U);
}

}  // namespace
}  // namespace cgsr::runtime
