#include "pipeline/runtime/stage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/runtime/stage_test_support.h"

namespace cgsr::runtime {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::HasSubstr;

/// A loop of two lines, run for as many frames as a test likes; `track` hands on the number of the frame.
class Loop {
 public:
  explicit Loop(std::vector<ScheduleRow> rows, BudgetSource source = BudgetSource::kClock)
      : runner_(clock_, schedule_of(std::move(rows)), source, stop_) {
    if (const auto bound = runner_.bind(track_, decide_); !bound) throw std::runtime_error(bound.error().message);
  }

  /// \return the record of a frame in which track takes `track_takes`.
  const FrameRecord& frame(Duration track_takes) {
    track_takes_ = track_takes;
    runner_.begin_frame(frame_start(next_));
    const auto& tracked = runner_.run(track_, next_);
    last_ = runner_.run(decide_, tracked.value).value;
    ++next_;
    return runner_.end_frame();
  }

  [[nodiscard]] const Aged<int>& tracked() const { return track_.last(); }
  [[nodiscard]] int decided() const { return last_; }
  [[nodiscard]] const StageRunner& runner() const { return runner_; }
  MotionStop& stop() { return stop_; }

 private:
  SimulatedClock clock_;
  MotionStop stop_;
  Duration track_takes_{};
  Duration decide_takes_ = microseconds(50);
  Stage<Work> track_{"track", Work{&clock_, &track_takes_}};
  Stage<Work> decide_{"decide", Work{&clock_, &decide_takes_}};
  StageRunner runner_;
  int next_ = 0;
  int last_ = -1;
};

std::vector<ScheduleRow> every_frame() {
  return {stage_row("track", 1, 0, 7000), stage_row("decide", 1, 0, 500)};
}

TEST(Stage, RunsMeasuresAndHandsOn) {
  Loop loop(every_frame());
  loop.frame(milliseconds(20));  // the warm-up
  const auto& record = loop.frame(milliseconds(5));
  EXPECT_EQ(loop.decided(), 1);
  EXPECT_EQ(loop.tracked().age, Duration::zero());
  EXPECT_EQ(record.frame, 1U);
  EXPECT_EQ(record.image_sequence, 1U);
  EXPECT_EQ(record.stage_count, 2U);
  EXPECT_EQ(record.stages[0].outcome, StageOutcome::kRan);
  EXPECT_EQ(record.stages[0].elapsed_ns, 5'000'000);
  EXPECT_FALSE(record.stages[0].overran);
  EXPECT_EQ(record.stages[1].elapsed_ns, 50'000);
  EXPECT_EQ(record.finished - record.started, microseconds(5050));
}

TEST(Stage, WhereTheScheduleHasNoTurnHandsOnTheLastOutputWithItsAge) {
  Loop loop({stage_row("track", 3, 0, 7000), stage_row("decide", 1, 0, 500)});
  for (int i = 0; i < 9; ++i) {
    const auto& record = loop.frame(milliseconds(1));
    const int since = i % 3;
    EXPECT_EQ(loop.decided(), i - since) << i;
    EXPECT_EQ(loop.tracked().age, since * kPeriod) << i;
    EXPECT_EQ(record.stages[0].outcome, since == 0 ? StageOutcome::kRan : StageOutcome::kNotDue) << i;
  }
}

// The overrun detector, tested itself: a stage made slow is found out, loses its next turn, and the table shows both.
TEST(StageFault, ASlowStageLosesItsNextTurnAndTheTableShowsIt) {
  Loop loop(every_frame());
  loop.frame(milliseconds(1));
  EXPECT_TRUE(loop.frame(microseconds(7001)).stages[0].overran);
  EXPECT_EQ(loop.decided(), 1) << "a late output is an output";
  EXPECT_EQ(loop.frame(milliseconds(1)).stages[0].outcome, StageOutcome::kSkipped);
  EXPECT_EQ(loop.decided(), 1) << "the last one";
  EXPECT_EQ(loop.tracked().age, kPeriod);
  EXPECT_EQ(loop.frame(microseconds(7000)).stages[0].outcome, StageOutcome::kRan);
  EXPECT_FALSE(loop.frame(microseconds(7000)).stages[0].overran) << "the whole budget may be used";
  EXPECT_EQ(loop.decided(), 4);

  const auto track = loop.runner().table().stages()[0];
  EXPECT_EQ(track.runs, 3U);
  EXPECT_EQ(track.overruns, 1U);
  EXPECT_EQ(track.skips, 1U);
  EXPECT_EQ(track.worst_us, 7001.0);
  EXPECT_EQ(loop.stop().look(), 0U) << "policy skip stops nobody";
}

// An overrun must not starve a stage that runs rarely: the turn lost is its own next one, and only that.
TEST(StageFault, ALostTurnIsTheStagesOwnNextOne) {
  Loop loop({stage_row("track", 2, 0, 7000), stage_row("decide", 1, 0, 500)});
  std::vector<StageOutcome> outcomes;
  for (int i = 0; i < 8; ++i) {
    outcomes.push_back(loop.frame(i == 2 ? milliseconds(9) : milliseconds(1)).stages[0].outcome);
  }
  using enum StageOutcome;
  EXPECT_THAT(outcomes, testing::ElementsAre(kRan, kNotDue, kRan, kNotDue, kSkipped, kNotDue, kRan, kNotDue));
}

TEST(StageFault, AStageThatIsAlwaysSlowRunsEveryOtherTime) {
  Loop loop(every_frame());
  for (int i = 0; i < 101; ++i) loop.frame(milliseconds(10));
  const auto track = loop.runner().table().stages()[0];
  EXPECT_EQ(track.runs, 50U);
  EXPECT_EQ(track.overruns, 50U);
  EXPECT_EQ(track.skips, 50U);
}

TEST(StageFault, OfTheSafetyChainStopsTheMotionUntilItIsInTimeAgain) {
  Loop loop({stage_row("track", 1, 0, 7000, OnOverrun::kStopMotion), stage_row("decide", 1, 0, 500)});
  loop.frame(milliseconds(1));
  EXPECT_EQ(loop.stop().look(), 0U);
  loop.frame(milliseconds(8));
  EXPECT_EQ(loop.stop().look(), 1U);
  EXPECT_EQ(loop.frame(milliseconds(8)).stages[0].outcome, StageOutcome::kRan) << "it is never skipped";
  EXPECT_EQ(loop.stop().look(), 1U);
  loop.frame(milliseconds(1));
  EXPECT_EQ(loop.stop().look(), 0U);
}

TEST(StageFault, AFrameThatOutlastsThePeriodIsLate) {
  Loop loop(every_frame());
  loop.frame(milliseconds(1));
  EXPECT_FALSE(loop.frame(milliseconds(32)).late);
  loop.frame(milliseconds(1));
  EXPECT_TRUE(loop.frame(milliseconds(33)).late);
  EXPECT_EQ(loop.runner().table().frames().late, 1U);
}

TEST(Stage, TheWarmUpRunsEverythingAndJudgesNothing) {
  Loop loop({stage_row("track", 3, 2, 7000, OnOverrun::kStopMotion), stage_row("decide", 1, 0, 500)});
  const auto& record = loop.frame(milliseconds(500));
  EXPECT_TRUE(record.warm_up);
  EXPECT_EQ(record.stages[0].outcome, StageOutcome::kRan);
  EXPECT_FALSE(record.stages[0].overran);
  EXPECT_FALSE(record.late);
  EXPECT_EQ(loop.stop().look(), 0U);
  EXPECT_EQ(loop.runner().table().frames().frames, 0U);
  EXPECT_EQ(loop.runner().table().stages()[0].runs, 0U);
  EXPECT_FALSE(loop.frame(milliseconds(1)).warm_up);
}

// In lock-step a machine may be as slow as it likes: nothing overruns, nothing is skipped, the outputs are the same.
TEST(Stage, InLockStepTimeDecidesNothing) {
  Loop loop(every_frame(), BudgetSource::kUnits);
  for (int i = 0; i < 10; ++i) {
    const auto& record = loop.frame(std::chrono::seconds(1));
    EXPECT_EQ(record.stages[0].outcome, StageOutcome::kRan);
    EXPECT_FALSE(record.stages[0].overran);
    EXPECT_FALSE(record.late);
    EXPECT_EQ(record.stages[0].elapsed_ns, 1'000'000'000) << "measured all the same";
  }
}

/// One function with all that a runner needs, for tests of a single stage.
template <class Function>
struct Single {
  explicit Single(Function function, ScheduleRow row = stage_row("only", 1, 0, 1000),
                  BudgetSource source = BudgetSource::kClock)
      : stage("only", std::move(function)), runner(clock, schedule_of({std::move(row)}), source, stop) {
    if (!runner.bind(stage)) throw std::runtime_error("bind");
  }
  template <class... Inputs>
  const FrameRecord& frame(const Inputs&... inputs) {
    runner.begin_frame(frame_start(next++));
    runner.run(stage, inputs...);
    return runner.end_frame();
  }
  SimulatedClock clock;
  MotionStop stop;
  Stage<Function> stage;
  StageRunner runner;
  int next = 0;
};

TEST(StageFault, AnExceptionEndsAtTheBoundaryAsAFaultWithAName) {
  Single single([](int input) {
    if (input == 2) throw std::runtime_error("resize: inv_scale_x > 0");
    if (input == 3) throw 42;  // NOLINT(hicpp-exception-baseclass)
    return input;
  });
  single.frame(0);
  single.frame(1);
  const auto record = single.frame(2);
  EXPECT_EQ(record.stages[0].outcome, StageOutcome::kFaulted);
  EXPECT_EQ(fault_of(record), "only: resize: inv_scale_x > 0");
  EXPECT_EQ(single.stage.last().value, 1) << "the last good output";
  EXPECT_EQ(single.stage.last().age, kPeriod);
  EXPECT_EQ(fault_of(single.frame(3)), "only: an exception that is no std::exception");
  EXPECT_EQ(single.frame(4).stages[0].outcome, StageOutcome::kRan);
  EXPECT_EQ(single.stage.last().value, 4);
  EXPECT_EQ(single.runner.table().stages()[0].faults, 2U);
  EXPECT_EQ(single.stop.look(), 0U);
}

TEST(StageFault, AFaultInTheSafetyChainStopsTheMotion) {
  Single single(
      [](bool good) {
        if (!good) throw std::runtime_error("no");
        return 0;
      },
      stage_row("only", 1, 0, 1000, OnOverrun::kStopMotion));
  single.frame(true);
  single.frame(false);
  EXPECT_EQ(single.stop.look(), 1U);
  single.frame(true);
  EXPECT_EQ(single.stop.look(), 0U);
}

TEST(Stage, ThatNeverRanHasNoAge) {
  Single single([]() -> int { throw std::runtime_error("never"); });
  single.frame();
  EXPECT_FALSE(single.stage.last().ever());
  EXPECT_GT(single.stage.last().age, std::chrono::hours(24));
}

int counted_in_units(WorkBudget& budget, int wanted) {
  int done = 0;
  while (done < wanted && budget.grant()) ++done;
  return done;
}

TEST(Stage, ThatWorksInUnitsGetsABudget) {
  Single single(&counted_in_units, stage_row("only", 1, 0, 1000, OnOverrun::kSkip, 10), BudgetSource::kUnits);
  const auto few = single.frame(4);
  EXPECT_EQ(single.stage.last().value, 4);
  EXPECT_EQ(few.stages[0].granted, 4U);
  EXPECT_FALSE(few.stages[0].refused) << "it stopped by itself";
  const auto many = single.frame(50);
  EXPECT_EQ(single.stage.last().value, 10);
  EXPECT_EQ(many.stages[0].granted, 10U);
  EXPECT_TRUE(many.stages[0].refused) << "the budget stopped it";
  EXPECT_EQ(single.runner.table().stages()[0].refusals, 1U);
}

TEST(Stage, ThatWorksInUnitsEndsInTimeWhenLive) {
  SimulatedClock* clock = nullptr;
  Single single([&](WorkBudget& budget) {
    int done = 0;
    while (budget.grant()) {
      clock->advance(microseconds(150));
      ++done;
    }
    return done;
  });
  clock = &single.clock;
  single.frame();
  const auto& record = single.frame();
  EXPECT_EQ(single.stage.last().value, 6);
  EXPECT_FALSE(record.stages[0].overran);
  EXPECT_TRUE(record.stages[0].refused);
}

struct Missing {
  using Output = int;
  static constexpr std::string_view kName = "only";
  int update(int input) { return input; }
};

TEST(Stage, WithoutAWorkerHasItsTurnAndTheDefaultOutput) {
  SimulatedClock clock;
  MotionStop stop;
  StageRunner runner(clock, schedule_of({stage_row("only", 1, 0, 1000)}), BudgetSource::kUnits, stop);
  Stage<Missing> stage(nullptr);
  ASSERT_TRUE(runner.bind(stage));
  runner.begin_frame(frame_start(0));
  EXPECT_EQ(runner.run(stage, 7).value, 0);
  EXPECT_TRUE(stage.last().fresh());
  EXPECT_EQ(runner.end_frame().stages[0].outcome, StageOutcome::kRan);
}

struct EverySecond {
  using Output = int;
  static constexpr std::string_view kName = "only";
  std::optional<int> update(int input) { return input % 2 == 0 ? std::optional<int>(input) : std::nullopt; }
};

TEST(Stage, ThatHasNothingNewKeepsItsLastOutputWhichAges) {
  SimulatedClock clock;
  MotionStop stop;
  StageRunner runner(clock, schedule_of({stage_row("only", 1, 0, 1000)}), BudgetSource::kUnits, stop);
  Stage<EverySecond> stage(std::make_unique<EverySecond>());
  ASSERT_TRUE(runner.bind(stage));
  const auto frame = [&](int number) {
    runner.begin_frame(frame_start(number));
    const Aged<int> output = runner.run(stage, number);
    EXPECT_EQ(runner.end_frame().stages[0].outcome, StageOutcome::kRan);
    return output;
  };
  EXPECT_FALSE(frame(1).ever());
  EXPECT_TRUE(frame(2).fresh());
  const Aged<int> kept = frame(3);
  EXPECT_EQ(kept.value, 2);
  EXPECT_EQ(kept.age, frame_start(3).stamp - frame_start(2).stamp);
  EXPECT_TRUE(frame(4).fresh());
}

// Whoever reads an output says how old is too old.
TEST(Aged, IsReadOnlyUpToTheAgeThatItsReaderStates) {
  Aged<int> never;
  EXPECT_EQ(never.within(Duration::max()), nullptr);
  const Aged<int> now{5, {}, Duration::zero()};
  ASSERT_NE(now.within(Duration::zero()), nullptr);
  EXPECT_EQ(*now.within(Duration::zero()), 5);
  const Aged<int> older{5, {}, milliseconds(66)};
  EXPECT_EQ(older.within(milliseconds(65)), nullptr);
  EXPECT_NE(older.within(milliseconds(66)), nullptr);
  static_assert(!std::is_convertible_v<Aged<int>, int>);
}

TEST(StageRunner, RefusesStagesAndRowsThatDoNotMatch) {
  SimulatedClock clock;
  MotionStop stop;
  StageRunner runner(clock, schedule_of(every_frame()), BudgetSource::kClock, stop);
  const auto nothing = [] { return 0; };
  Stage track("track", nothing);
  Stage again("track", nothing);
  Stage unknown("trakc", nothing);
  const auto bound = runner.bind(track, again, unknown);
  ASSERT_FALSE(bound);
  EXPECT_THAT(bound.error().message, HasSubstr("stage 'track' is there twice"));
  EXPECT_THAT(bound.error().message, HasSubstr("stage 'trakc' has no row in the schedule"));
  EXPECT_THAT(bound.error().message, HasSubstr("row 'decide' of the schedule has no stage"));
  runner.begin_frame(frame_start(0));
  EXPECT_THROW(runner.run(unknown), std::logic_error);
}

TEST(StageRunner, AFrameWithoutAnImageIsCounted) {
  Single single([] { return 1; });
  single.frame();
  single.runner.begin_frame({MonoTime{} + kPeriod, 0, false});
  single.runner.run(single.stage);
  EXPECT_FALSE(single.runner.end_frame().has_image);
  EXPECT_EQ(single.runner.table().frames().without_image, 1U);
}

}  // namespace
}  // namespace cgsr::runtime
