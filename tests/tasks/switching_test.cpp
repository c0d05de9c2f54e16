// Lamps that are switched: from what vision wants to what the lines did, and back to the image that shows it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/dummy/dummy_switches.h"
#include "pipeline/stages/switchboard.h"
#include "src/tasks/switch_task.h"

namespace cgsr::tasks::testing {
namespace {

using stages::LampLine;
using stages::SwitchAnswer;
using stages::Switchboard;
using stages::SwitchRequest;
using ::testing::HasSubstr;

constexpr Duration kPeriod = seconds(1.0 / 30.0);
constexpr Duration kAnswer = seconds(0.5);

MonoTime at(double time_s) {
  return MonoTime{seconds(time_s)};
}

class SwitchboardOf : public ::testing::Test {
 protected:
  /// Asks for what is due and answers.
  std::optional<SwitchRequest> switched(double now_s, double done_s, bool done = true) {
    const auto request = board_.next(at(now_s));
    if (request) board_.on_answer({*request, done, at(done_s)});
    return request;
  }
  [[nodiscard]] bool settled(double stamp_s) const { return board_.state(LampLine::kProbeLamp, at(stamp_s)).settled; }

  Switchboard board_{{true, true, false}, kPeriod, kAnswer};
};

using SwitchboardFault = SwitchboardOf;

// 'After' is the first image whose exposure begins a frame period or more after the acknowledged change.
TEST_F(SwitchboardOf, AnImageShowsAChangeAFramePeriodAfterItWasAcknowledged) {
  EXPECT_TRUE(settled(0.0)) << "nothing was ever switched";
  board_.want(LampLine::kProbeLamp, true);
  EXPECT_FALSE(settled(0.0));
  const auto request = board_.next(at(1.0));
  ASSERT_TRUE(request);
  EXPECT_TRUE(request->on);
  EXPECT_EQ(board_.next(at(1.0)), std::nullopt) << "one at a time";
  EXPECT_FALSE(settled(1.2));
  board_.on_answer({*request, true, at(1.21)});
  EXPECT_FALSE(settled(1.21));
  EXPECT_FALSE(settled(1.24));
  EXPECT_TRUE(settled(1.21 + to_seconds(kPeriod)));
  EXPECT_TRUE(board_.state(LampLine::kProbeLamp, at(1.3)).on);
  EXPECT_FALSE(board_.state(LampLine::kRoomLamp, at(1.3)).on);
}

TEST_F(SwitchboardOf, ALineThatIsNotThereIsNeverAskedFor) {
  board_.want(LampLine::kFillLight, true);
  EXPECT_EQ(board_.next(at(1.0)), std::nullopt);
  EXPECT_FALSE(board_.state(LampLine::kFillLight, at(1.0)).there);
}

TEST_F(SwitchboardFault, ARefusalOrNoAnswerInTimeMakesALineSilentForGood) {
  board_.want(LampLine::kProbeLamp, true);
  ASSERT_TRUE(switched(1.0, 1.05, false));
  EXPECT_TRUE(board_.state(LampLine::kProbeLamp, at(1.1)).silent);
  EXPECT_FALSE(board_.state(LampLine::kProbeLamp, at(1.1)).on);
  board_.want(LampLine::kProbeLamp, false);

  board_.want(LampLine::kRoomLamp, true);
  ASSERT_TRUE(board_.next(at(2.0)));
  static_cast<void>(board_.next(at(2.4)));
  EXPECT_FALSE(board_.state(LampLine::kRoomLamp, at(2.4)).silent);
  static_cast<void>(board_.next(at(2.6)));
  EXPECT_TRUE(board_.state(LampLine::kRoomLamp, at(2.6)).silent);
}

// The lamp of a room that stayed switched is asked a few times more to go back, not for ever.
TEST_F(SwitchboardFault, ALampThatDoesNotGoBackIsAskedThreeTimes) {
  board_.want(LampLine::kRoomLamp, true);
  ASSERT_TRUE(switched(1.0, 1.05));
  board_.want(LampLine::kRoomLamp, false);
  int asked = 0;
  for (double now_s = 1.1; now_s < 20.0; now_s += 0.033) asked += switched(now_s, now_s, false) ? 1 : 0;
  EXPECT_EQ(asked, 3);
}

class LampTask : public ::testing::Test {
 protected:
  LampTask() { EXPECT_TRUE(switches_.start()); }
  SwitchAnswer answer_to(LampLine line, bool on) {
    EXPECT_TRUE(links_.switch_requests.push(SwitchRequest{line, on, 7, at(1.0)}));
    clock_.advance_to(at(1.2));
    EXPECT_EQ(task_.step(), std::nullopt);
    const auto answer = links_.switch_answers.pop();
    EXPECT_TRUE(answer);
    return answer.value_or(SwitchAnswer{});
  }

  hal::DummySwitches switches_{{{"glow", hal::LineDirection::kOutput}, {"arm", hal::LineDirection::kInput}}};
  SimulatedClock clock_;
  Links links_;
  SwitchTask task_{switches_, {"", {"glow", "gone", ""}}, clock_, links_};
};

TEST_F(LampTask, SwitchesAcknowledgesAndLeavesARecord) {
  const auto answer = answer_to(LampLine::kProbeLamp, true);
  EXPECT_TRUE(answer.done);
  EXPECT_EQ(answer.request.number, 7U);
  EXPECT_EQ(answer.at, at(1.2));
  EXPECT_TRUE(switches_.level("glow"));
  const auto record = links_.switchings.pop();
  ASSERT_TRUE(record);
  EXPECT_EQ(record->answer.request.asked_at, at(1.0));
  EXPECT_STREQ(record->problem.data(), "");
}

TEST_F(LampTask, ALineThatDoesNotAnswerIsNamedInItsRecord) {
  EXPECT_FALSE(answer_to(LampLine::kRoomLamp, true).done);
  const auto record = links_.switchings.pop();
  ASSERT_TRUE(record);
  EXPECT_THAT(record->problem.data(), HasSubstr("gone"));
}

TEST_F(LampTask, AConfiguredLineThatDoesNotExistIsNamedAtBoot) {
  const auto checked = check_lines(switches_, {"arm", {"glow", "gone", ""}});
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().message, HasSubstr("no line 'gone'"));
  EXPECT_THAT(checked.error().message, HasSubstr("glow, arm"));
  EXPECT_TRUE(check_lines(switches_, {"arm", {"", "glow", ""}}));
}

}  // namespace
}  // namespace cgsr::tasks::testing
