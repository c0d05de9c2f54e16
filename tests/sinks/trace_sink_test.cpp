#include "src/sinks/trace_sink.h"

#include <random>

#include <gmock/gmock.h>

#include "tests/sinks/trace_check.h"
#include "tests/support/scratch_folder.h"

namespace cgsr::sinks {
namespace {

using runtime::FrameRecord;
using runtime::StageOutcome;

constexpr Duration kPeriod = seconds(1.0 / 30.0);

class TraceSinkTest : public testing::Test {
 protected:
  TraceSinkTest()
      : schedule_(*runtime::Schedule::make({{"decode", {}}, {"search", {}}, {"decide", {}}}, kPeriod)),
        sink_(std::move(*TraceSink::create((scratch_ / "trace.json").string(), schedule_))) {}

  FrameRecord record(std::uint64_t image, MonoTime stamp, Duration elapsed) {
    FrameRecord frame;
    frame.frame = frame.image_sequence = image;
    frame.stamp = stamp;
    frame.started = MonoTime{seconds(1000.0)};  // another clock: in lock-step stages are measured in real time
    frame.finished = frame.started + elapsed;
    frame.stage_count = 3;
    frame.has_image = true;
    for (std::size_t i = 0; i < 3; ++i) {
      frame.stages[i].outcome = StageOutcome::kRan;
      frame.stages[i].elapsed_ns = elapsed.count() / 4;
    }
    return frame;
  }

  void add(const FrameRecord& frame, MonoTime taken_at) {
    const stages::FrameResult result;
    const MotionStatus motion;
    ASSERT_TRUE(sink_->on_image({result, frame, motion, nullptr, taken_at}));
  }

  void cycle(MonoTime at, MonoTime goal_stamp) {
    MotionStatus status;
    status.stamp = at;
    status.goal_stamp = goal_stamp;
    ASSERT_TRUE(sink_->on_control_cycle(status));
  }

  test::TraceContents read() {
    EXPECT_TRUE(sink_->finish());
    return test::check_trace_file(scratch_ / "trace.json");
  }

  test::ScratchFolder scratch_;
  runtime::Schedule schedule_;
  std::unique_ptr<TraceSink> sink_;
};

MonoTime at(double s) {
  return MonoTime{seconds(s)};
}

TEST_F(TraceSinkTest, SkipsOverrunsFaultsAndHandOversAreThere) {
  FrameRecord frame = record(7, at(1.0), seconds(0.02));
  frame.stages[0].overran = true;
  frame.stages[1].outcome = StageOutcome::kSkipped;
  frame.stages[2].outcome = StageOutcome::kFaulted;
  add(frame, at(1.025));
  cycle(at(1.03), at(1.0));
  cycle(at(1.04), at(1.0));

  const auto trace = read();

  EXPECT_THAT(trace.problems, testing::IsEmpty());
  EXPECT_EQ(trace.instants.at("decode: overrun"), 1);
  EXPECT_EQ(trace.instants.at("search: skipped"), 1);
  EXPECT_EQ(trace.instants.at("decide: fault"), 1);
  EXPECT_EQ(trace.arrows.at("image"), 1);
  EXPECT_EQ(trace.arrows.at("report"), 1);
  EXPECT_EQ(trace.arrows.at("goal"), 1) << "one for the first cycle that has the goal";
}

TEST_F(TraceSinkTest, AGoalThatNoCycleHadHasNoArrow) {
  add(record(0, at(0.0), seconds(0.02)), at(0.0));
  add(record(1, at(0.033), seconds(0.02)), at(0.033));
  cycle(at(0.07), at(0.033));
  const auto trace = read();
  EXPECT_THAT(trace.problems, testing::IsEmpty());
  EXPECT_EQ(trace.arrows.at("image"), 2);
  EXPECT_EQ(trace.arrows.at("goal"), 1);
}

// Whatever a run does: late frames, lost reports, images that stay out, cycles that are known before their frame.
TEST_F(TraceSinkTest, SlicesNestAndArrowsHaveBothEndsWhateverHappens) {
  std::mt19937 random(20261124);
  const auto chance = [&random](double share) { return std::bernoulli_distribution(share)(random); };
  std::uniform_real_distribution<double> elapsed_s(0.0, 0.12);
  std::uniform_real_distribution<double> jitter_s(0.0, 0.012);
  MonoTime next_cycle{};
  MonoTime goal = MonoTime::min();
  int images = 0;
  for (int i = 0; i < 2000; ++i) {
    const MonoTime stamp = MonoTime{i * kPeriod} + seconds(jitter_s(random));
    FrameRecord frame = record(static_cast<std::uint64_t>(i), stamp, seconds(elapsed_s(random)));
    for (std::size_t s = 0; s < 3; ++s) frame.stages[s].overran = chance(0.2);
    frame.stages[1].outcome = chance(0.2) ? StageOutcome::kSkipped : StageOutcome::kRan;
    const bool cycles_first = chance(0.5);
    const auto cycles = [&] {
      for (; next_cycle < stamp + kPeriod; next_cycle += seconds(0.01)) {
        if (next_cycle >= stamp + seconds(0.02)) goal = stamp;
        cycle(next_cycle, goal);
      }
    };
    if (cycles_first) cycles();
    if (chance(0.1)) {
      frame.has_image = false;
      ASSERT_TRUE(sink_->on_missing_image(frame));
    } else if (!chance(0.1)) {
      add(frame, stamp + seconds(jitter_s(random)));
      ++images;
    }
    if (!cycles_first) cycles();
  }

  const auto trace = read();

  EXPECT_THAT(trace.problems, testing::IsEmpty()) << trace.problems.front();
  EXPECT_EQ(trace.arrows.at("image"), images);
  EXPECT_GT(trace.arrows.at("goal"), images / 3) << "frames that are drawn after the cycle have none";
  EXPECT_GT(trace.instants.at("search: skipped"), 0);
  EXPECT_EQ(trace.arrows.at("report"), trace.slices.at("report"));
}

}  // namespace
}  // namespace cgsr::sinks
