// Where the time of a run goes, counted from records.
#include "src/sinks/profile.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/sinks/profile_sink.h"
#include "tests/support/scratch_folder.h"

namespace cgsr::sinks {
namespace {

using runtime::FrameRecord;
using runtime::StageOutcome;
using testing::HasSubstr;

constexpr Duration kPeriod = seconds(0.033);

MonoTime at_ms(double ms) {
  return MonoTime{seconds(100.0 + ms / 1000.0)};
}

runtime::Schedule schedule() {
  return *runtime::Schedule::make({{"track", {.budget_us = 10000}}}, kPeriod);
}

FrameRecord frame(double frame_ms, double stage_ms, StageOutcome outcome = StageOutcome::kRan) {
  FrameRecord record;
  record.has_image = true;
  record.started = at_ms(0.0);
  record.finished = at_ms(frame_ms);
  record.stage_count = 1;
  record.stages[0].outcome = outcome;
  record.stages[0].elapsed_ns = static_cast<std::int64_t>(stage_ms * 1e6);
  return record;
}

TEST(Profile, CountsAStageAgainstItsBudget) {
  Profile profile(schedule());
  for (int i = 0; i < 98; ++i) profile.add(frame(6.0, 5.0));
  auto slow = frame(50.0, 40.0);
  slow.late = true;
  slow.stages[0].overran = true;
  profile.add(slow);
  auto ended = frame(6.0, 5.0);
  ended.stages[0].refused = true;
  profile.add(ended);
  profile.add(frame(1.0, 0.0, StageOutcome::kSkipped));
  auto warm_up = frame(500.0, 400.0);
  warm_up.warm_up = true;
  profile.add(warm_up);

  const auto json = profile.json();
  const auto& stage = json["stages"]["track"];
  EXPECT_EQ(stage["runs"], 100);
  EXPECT_EQ(stage["skips"], 1);
  EXPECT_EQ(stage["overruns"], 1);
  EXPECT_EQ(stage["ended_by_budget"], 1);
  EXPECT_NEAR(stage["mean_us"].get<double>(), 5350.0, 1.0);
  EXPECT_NEAR(stage["p50_us"].get<double>(), 5000.0, 320.0);
  EXPECT_NEAR(stage["worst_us"].get<double>(), 40000.0, 1.0);
  EXPECT_NEAR(stage["share_of_budget"].get<double>(), 0.535, 0.001);
  EXPECT_EQ(json["frame"]["frames"], 101);
  EXPECT_EQ(json["frame"]["late"], 1);
  EXPECT_EQ(json["frame"]["tenths_of_period"][1], 99) << "6 ms of 33";
  EXPECT_EQ(json["frame"]["tenths_of_period"][15], 1);
}

// Each image's first command counts, and only that one.
TEST(Profile, MeasuresFromTheExposureToTheFirstCommand) {
  Profile profile(schedule());
  MotionStatus status;
  status.cause = StopCause::kNone;
  for (int image = 0; image < 10; ++image) {
    status.goal_stamp = at_ms(33.0 * image);
    for (int cycle = 0; cycle < 3; ++cycle) {
      status.stamp = status.goal_stamp + seconds(0.040 + 0.010 * cycle);
      profile.add(status);
    }
  }
  status.cause = StopCause::kGoalStale;
  profile.add(status);
  const auto json = profile.json();
  EXPECT_EQ(json["exposure_to_command"]["images"], 10);
  EXPECT_NEAR(json["exposure_to_command"]["worst_us"].get<double>(), 40000.0, 1.0);
  EXPECT_EQ(json["stop_causes"][std::string(to_string(StopCause::kNone))], 30);
  EXPECT_EQ(json["stop_causes"][std::string(to_string(StopCause::kGoalStale))], 1);
}

TEST(ProfileText, ShowsStagesHistogramAndCausesAndTakesAnyObject) {
  Profile profile(schedule());
  for (int i = 0; i < 5; ++i) profile.add(frame(6.0, 5.0));
  profile.add(MotionStatus{});
  const std::string text = profile_text(profile.json());
  EXPECT_THAT(text, HasSubstr("track"));
  EXPECT_THAT(text, HasSubstr("50 %"));
  EXPECT_THAT(text, HasSubstr("|##################################################| 5"));
  EXPECT_THAT(text, HasSubstr("exposure to wheel command"));
  EXPECT_THAT(profile_text(nlohmann::ordered_json::object()), HasSubstr("stage"));
  EXPECT_THAT(profile_text(nlohmann::ordered_json::parse(R"({"stages": {"a": {"runs": "x"}}})")), HasSubstr("a"));
}

TEST(ProfileSink, RewritesItsFileOnceASecondAndADiskThatTakesNothingEndsNothing) {
  const test::ScratchFolder folder;
  const auto rings = [] { return nlohmann::ordered_json::object(); };
  ProfileSink sink(schedule(), (folder / "status.json").string(), rings);
  MotionStatus status;
  for (int ms = 0; ms < 2500; ms += 10) {
    status.stamp = at_ms(ms);
    ASSERT_TRUE(sink.on_control_cycle(status));
  }
  std::ifstream in(folder / "status.json");
  EXPECT_EQ(nlohmann::json::parse(in)["motion"]["control_cycles"], 201) << "at 0, 1 and 2 s";
  ProfileSink nowhere(schedule(), "/no/such/folder/status.json", rings);
  status.stamp = at_ms(5000.0);
  EXPECT_TRUE(nowhere.on_control_cycle(status));
  EXPECT_TRUE(nowhere.finish());
}

}  // namespace
}  // namespace cgsr::sinks
