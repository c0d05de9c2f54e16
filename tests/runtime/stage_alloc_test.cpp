#include <gtest/gtest.h>

#include <memory>

#include "pipeline/runtime/images_in_time.h"
#include "platform/ring.h"
#include "tests/runtime/stage_test_support.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::runtime {
namespace {

// 1000 frames with every kind of turn: run, not due, overrun, skipped, bounded by the clock; records into a ring, as
// the vision loop does it.
TEST(StageAlloc, FramesNeitherAllocateNorFaultAfterTheWarmUp) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  RealClock clock;
  MotionStop stop;
  const auto spin = [&](Duration duration) {
    const auto end = clock.now() + duration;
    while (clock.now() < end) {
    }
  };
  int frame = 0;
  Stage rare("rare", [&] { return ++frame; });
  Stage slow("slow", [&](int input) {
    if (input % 5 == 0) spin(std::chrono::microseconds(150));
    return input;
  });
  Stage bounded("bounded", [&](WorkBudget& budget, int input) {
    while (budget.grant()) spin(std::chrono::microseconds(20));
    return input;
  });
  StageRunner runner(clock,
                     schedule_of({stage_row("rare", 2, 0, 1000), stage_row("slow", 1, 0, 100),
                                  stage_row("bounded", 1, 0, 100, OnOverrun::kStopMotion)}),
                     BudgetSource::kClock, stop);
  ASSERT_TRUE(runner.bind(rare, slow, bounded));
  ImagesInTime images(kPeriod);
  const auto records = std::make_unique<Ring<FrameRecord, 64, Overflow::kDiscard>>();
  const auto housekeeping = std::make_unique<StageTable>(runner.schedule());

  const auto cycle = [&](int i) {
    runner.begin_frame(frame_start(i));
    const int counted = runner.run(rare).value;
    const int passed = runner.run(slow, counted).value;
    runner.run(bounded, passed);
    const auto& record = runner.end_frame();
    images.dealt_with(record.image_sequence, record.started, record.finished);
    records->push(FrameRecord(record));
    if (const auto popped = records->pop()) housekeeping->add(*popped);
    return stop.look();
  };
  for (int i = 0; i < 20; ++i) cycle(i);

  const test::AllocationGuard guard;
  for (int i = 20; i < 1020; ++i) cycle(i);
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.page_faults(), 0U);

  const auto stages = runner.table().stages();
  EXPECT_GT(stages[0].not_due, 400U);
  EXPECT_GT(stages[1].overruns, 50U);
  EXPECT_GT(stages[1].skips, 50U);
  EXPECT_GT(stages[2].refusals, 900U);
}

}  // namespace
}  // namespace cgsr::runtime
