#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tests/runtime/stage_test_support.h"

namespace cgsr::runtime {
namespace {

/// A loop whose outputs depend on everything that time decides: how many units search got, and which turns each stage
/// had.
class Loop {
 public:
  Loop(SimulatedClock& clock, std::mt19937& weather, BudgetSource source)
      : search_{"search", Search{&clock, &weather}},
        mix_{"mix", Mix{&clock, &weather}},
        runner_(clock,
                schedule_of({stage_row("search", 1, 0, 5000, OnOverrun::kSkip, 20),
                             stage_row("mix", 2, 1, 2000, OnOverrun::kStopMotion)}),
                source, stop_) {
    if (!runner_.bind(search_, mix_)) throw std::runtime_error("bind");
  }

  FrameRecord frame(int i, const FrameRecord* repeat = nullptr) {
    runner_.begin_frame(frame_start(i), repeat);
    const auto& found = runner_.run(search_, i);
    output_ = runner_.run(mix_, found).value * 31 + found.value;
    stops_ = stop_.look();
    return runner_.end_frame();
  }
  [[nodiscard]] std::uint64_t output() const { return output_; }
  [[nodiscard]] std::uint32_t stops() const { return stops_; }

 private:
  struct Search {
    SimulatedClock* clock;
    std::mt19937* weather;
    std::uint64_t operator()(WorkBudget& budget, int frame) const {
      std::uint64_t units = 0;
      while (units < 30 && budget.grant()) {
        clock->advance(std::chrono::microseconds((*weather)() % 700));
        ++units;
      }
      return units + static_cast<std::uint64_t>(frame) * 1000;
    }
  };
  struct Mix {
    SimulatedClock* clock;
    std::mt19937* weather;
    std::uint64_t operator()(const Aged<std::uint64_t>& found) const {
      clock->advance(std::chrono::microseconds((*weather)() % 2200));
      return found.value + static_cast<std::uint64_t>(found.age.count());
    }
  };
  MotionStop stop_;
  Stage<Search> search_;
  Stage<Mix> mix_;
  StageRunner runner_;
  std::uint64_t output_ = 0;
  std::uint32_t stops_ = 0;
};

// What was decided by time on one machine is repeated on another with quite different times: same outputs, same stops.
TEST(StageReplay, RepeatsEveryDecisionOfTheRecording) {
  constexpr int kFrames = 2000;
  std::vector<FrameRecord> recording;
  std::vector<std::uint64_t> outputs;
  std::vector<std::uint32_t> stops;
  {
    SimulatedClock clock;
    std::mt19937 weather(1);
    Loop live(clock, weather, BudgetSource::kClock);
    for (int i = 0; i < kFrames; ++i) {
      recording.push_back(live.frame(i));
      outputs.push_back(live.output());
      stops.push_back(live.stops());
    }
  }

  // A recording that holds every cause shows something; one without an overrun would pass by luck.
  int overruns = 0, skips = 0, refusals = 0, own_ends = 0, not_due = 0;
  for (const auto& record : recording) {
    for (std::size_t row = 0; row < record.stage_count; ++row) {
      overruns += record.stages[row].overran ? 1 : 0;
      skips += record.stages[row].outcome == StageOutcome::kSkipped ? 1 : 0;
      not_due += record.stages[row].outcome == StageOutcome::kNotDue ? 1 : 0;
    }
    if (record.stages[0].outcome != StageOutcome::kRan) continue;
    (record.stages[0].refused ? refusals : own_ends) += 1;
  }
  EXPECT_GT(overruns, 10);
  EXPECT_GT(skips, 10);
  EXPECT_GT(refusals, 10);
  EXPECT_GT(not_due, 10);

  SimulatedClock clock;
  std::mt19937 other_weather(2);
  Loop replay(clock, other_weather, BudgetSource::kUnits);
  for (int i = 0; i < kFrames; ++i) {
    const auto record = replay.frame(i, &recording[static_cast<std::size_t>(i)]);
    ASSERT_EQ(replay.output(), outputs[static_cast<std::size_t>(i)]) << i;
    ASSERT_EQ(replay.stops(), stops[static_cast<std::size_t>(i)]) << i;
    const auto& then = recording[static_cast<std::size_t>(i)];
    ASSERT_EQ(record.late, then.late) << i;
    for (std::size_t row = 0; row < then.stage_count; ++row) {
      ASSERT_EQ(record.stages[row].outcome, then.stages[row].outcome) << i;
      ASSERT_EQ(record.stages[row].granted, then.stages[row].granted) << i;
      ASSERT_EQ(record.stages[row].refused, then.stages[row].refused) << i;
      ASSERT_EQ(record.stages[row].overran, then.stages[row].overran) << i;
    }
  }
}

// A repetition may begin in the middle: turns that were lost because of an earlier frame are in the record.
TEST(StageReplay, MayBeginAnywhere) {
  std::vector<FrameRecord> recording;
  {
    SimulatedClock clock;
    std::mt19937 weather(1);
    Loop live(clock, weather, BudgetSource::kClock);
    for (int i = 0; i < 400; ++i) recording.push_back(live.frame(i));
  }
  int skips = 0;
  for (int begin = 1; begin < 400; ++begin) {
    SimulatedClock clock;
    std::mt19937 weather(2);
    Loop replay(clock, weather, BudgetSource::kUnits);
    const auto& then = recording[static_cast<std::size_t>(begin)];
    const auto now = replay.frame(begin, &then);
    ASSERT_EQ(now.frame, then.frame);
    for (std::size_t row = 0; row < then.stage_count; ++row) {
      ASSERT_EQ(now.stages[row].outcome, then.stages[row].outcome) << begin;
      skips += then.stages[row].outcome == StageOutcome::kSkipped ? 1 : 0;
    }
  }
  EXPECT_GT(skips, 3);
}

TEST(StageReplay, WithoutItsRecordTheOtherMachineWouldHaveDecidedOtherwise) {
  SimulatedClock one_clock;
  SimulatedClock other_clock;
  std::mt19937 weather(1);
  std::mt19937 other_weather(2);
  Loop one(one_clock, weather, BudgetSource::kClock);
  Loop other(other_clock, other_weather, BudgetSource::kClock);
  int different = 0;
  for (int i = 0; i < 200; ++i) {
    one.frame(i);
    other.frame(i);
    different += one.output() == other.output() ? 0 : 1;
  }
  EXPECT_GT(different, 100);
}

}  // namespace
}  // namespace cgsr::runtime
