#include "pipeline/runtime/schedule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <random>

namespace cgsr::runtime {
namespace {

using std::chrono::microseconds;
using testing::HasSubstr;
using testing::Not;

constexpr Duration kPeriod = microseconds(33'333);

ScheduleRow row(std::string name, int every_frames, int phase, int budget_us) {
  return {std::move(name), {every_frames, phase, budget_us, 0, OnOverrun::kSkip}};
}

std::string refusal(std::vector<ScheduleRow> rows, Duration period = kPeriod) {
  const auto schedule = Schedule::make(std::move(rows), period);
  return schedule ? std::string() : schedule.error().message;
}

TEST(Schedule, GivesEveryStageItsTurns) {
  const auto schedule = Schedule::make({row("decode", 1, 0, 1500), row("face", 3, 2, 6000)}, kPeriod);
  ASSERT_TRUE(schedule);
  EXPECT_EQ(schedule->hyperperiod_frames(), 3U);
  for (std::uint64_t frame = 0; frame < 9; ++frame) {
    EXPECT_TRUE(schedule->due(0, frame));
    EXPECT_EQ(schedule->due(1, frame), frame % 3 == 2) << frame;
  }
  EXPECT_EQ(schedule->planned(1), microseconds(1500));
  EXPECT_EQ(schedule->planned(2), microseconds(7500));
  EXPECT_EQ(schedule->find("face"), 1U);
  EXPECT_EQ(schedule->find("shirt"), std::nullopt);
}

// No tick wraps: after years the turns are where they were.
TEST(Schedule, KeepsItsTurnsForEver) {
  const auto schedule = Schedule::make({row("face", 3, 2, 6000)}, kPeriod);
  ASSERT_TRUE(schedule);
  for (const std::uint64_t start : {std::uint64_t{1} << 16, std::uint64_t{1} << 32, std::uint64_t{1} << 48}) {
    int turns = 0;
    for (std::uint64_t frame = start; frame < start + 300; ++frame) turns += schedule->due(0, frame) ? 1 : 0;
    EXPECT_EQ(turns, 100);
  }
}

TEST(Schedule, RefusesAFrameThatIsTooFullAndShowsItsSum) {
  const auto words = refusal({row("decode", 1, 0, 2000), row("track", 1, 0, 20'000), row("face", 2, 1, 12'000)});
  EXPECT_THAT(words, HasSubstr("frame 1 of 2 is planned for more than the 33333 µs between two images: "
                               "decode 2000 + track 20000 + face 12000 = 34000 µs"));
  EXPECT_THAT(words, Not(HasSubstr("frame 0")));
}

TEST(Schedule, PhasesThatKeepOutOfEachOthersWayMakeItFit) {
  EXPECT_THAT(refusal({row("mask", 2, 0, 20'000), row("face", 2, 0, 20'000)}), HasSubstr("= 40000 µs"));
  EXPECT_EQ(refusal({row("mask", 2, 0, 20'000), row("face", 2, 1, 20'000)}), "");
}

TEST(Schedule, AFrameMayBeFullToTheLastMicrosecond) {
  EXPECT_EQ(refusal({row("track", 1, 0, 33'000)}, microseconds(33'000)), "");
  EXPECT_NE(refusal({row("track", 1, 0, 33'000)}, microseconds(32'999)), "");
}

TEST(Schedule, MeasuresAgainstTheCamerasPeriod) {
  EXPECT_EQ(refusal({row("a", 1, 0, 30'000), row("b", 1, 0, 30'000)}, std::chrono::milliseconds(100)), "");
}

TEST(Schedule, NamesEveryProblemAtOnce) {
  const auto words =
      refusal({row("track", 1, 0, 1000), row("track", 1, 0, 1000), row("face", 2, 2, 1000), row("", 0, 0, 0)});
  EXPECT_THAT(words, HasSubstr("stage 'track' is there twice"));
  EXPECT_THAT(words, HasSubstr("stage 'face': phase = 2 is never reached with every_frames = 2"));
  EXPECT_THAT(words, HasSubstr("a stage has no name"));
  EXPECT_THAT(words, HasSubstr("every_frames = 0 and budget_us = 0 must be positive"));
}

TEST(Schedule, RefusesWhatItCannotHold) {
  std::vector<ScheduleRow> many;
  for (std::size_t i = 0; i <= kMostStages; ++i) many.push_back(row("s" + std::to_string(i), 1, 0, 100));
  EXPECT_THAT(refusal(many), HasSubstr("25 stages are more than 24"));
  EXPECT_THAT(refusal({row("a", 59, 0, 100), row("b", 53, 0, 100), row("c", 47, 0, 100)}), HasSubstr("common factors"));
  EXPECT_THAT(refusal({}, Duration::zero()), HasSubstr("must be positive"));
}

TEST(Schedule, ShowsAHandfulOfManyFullFrames) {
  const auto words = refusal({row("track", 1, 0, 33'000), row("mask", 1, 0, 33'000), row("rare", 60, 0, 100)});
  EXPECT_THAT(words, HasSubstr("frame 4 of 60"));
  EXPECT_THAT(words, Not(HasSubstr("frame 5 of 60")));
  EXPECT_THAT(words, HasSubstr("and 55 frames more"));
}

TEST(Schedule, PrintsAsItTookEffect) {
  auto decide = row("decide", 1, 0, 500);
  decide.parameters.on_overrun = OnOverrun::kStopMotion;
  decide.parameters.units = 40;
  const auto schedule = Schedule::make({row("track", 1, 0, 7000), row("face", 2, 1, 6000), decide}, kPeriod);
  ASSERT_TRUE(schedule);
  EXPECT_EQ(to_text(*schedule),
            "stage            every phase budget/µs   units  on overrun\n"
            "track                1     0      7000     all  skip\n"
            "face                 2     1      6000     all  skip\n"
            "decide               1     0       500      40  stop_motion\n"
            "repeats every 2 frames; the fullest, frame 1, is planned for 13500 of 33333 µs\n");
}

struct TwoStages {
  StageParameters track{1, 0, 7000, 0, OnOverrun::kSkip};
  StageParameters decide{1, 0, 500, 0, OnOverrun::kStopMotion};
  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("track", self.track, "chapter 3");
    visit.section("decide", self.decide, "what to do");
  }
};

TEST(Schedule, TakesItsRowsFromAParameterStruct) {
  const auto rows = rows_of(TwoStages{});
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].name, "track");
  EXPECT_EQ(rows[0].parameters.budget_us, 7000);
  EXPECT_EQ(rows[1].name, "decide");
  EXPECT_EQ(rows[1].parameters.on_overrun, OnOverrun::kStopMotion);
}

// Whatever the table: what is accepted fits in every frame that can come, what is refused does not in at least one.
TEST(ScheduleProperty, AcceptsExactlyWhatFits) {
  std::mt19937 random(20261121);
  const std::array<int, 6> periods{1, 2, 3, 4, 6, 10};
  int accepted = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<ScheduleRow> rows;
    for (unsigned i = 0; i <= random() % 6; ++i) {
      const int every = periods[random() % periods.size()];
      const int phase = static_cast<int>(random() % static_cast<unsigned>(every));
      rows.push_back(row("s" + std::to_string(i), every, phase, 100 + static_cast<int>(random() % 24'000)));
    }
    bool fits = true;
    for (int frame = 0; frame < 60; ++frame) {
      int sum_us = 0;
      for (const auto& each : rows) {
        if (frame % each.parameters.every_frames == each.parameters.phase) sum_us += each.parameters.budget_us;
      }
      fits = fits && microseconds(sum_us) <= kPeriod;
    }
    ASSERT_EQ(refusal(rows).empty(), fits) << trial;
    accepted += fits ? 1 : 0;
  }
  EXPECT_GT(accepted, 200);
  EXPECT_LT(accepted, 1800);
}

}  // namespace
}  // namespace cgsr::runtime
