// A robot that boots where nobody tells it: the robot's program in the simulated home, images of half the size.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace cgsr::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class RunAnywhere : public ::testing::Test {
 protected:
  /// It stands elsewhere than its file says, and may turn from a second on.
  std::string robot(const Keys& changes = {}) {
    write_text(scratch_ / "scenario.toml",
               "world = \"" CGSR_SOURCE_DIR
               "/config/worlds/home.toml\"\n"
               "robot = \"robot\"\n"
               "start = { given = true, x_m = 4.6, y_m = 3.2, heading_deg = 70.0 }\n"
               "camera = { edge_samples = 1 }\n"
               "line = [{ name = \"arming\", input = true }]\n"
               "line_event = [{ what = \"pressed\", line = \"arming\", from_s = 1.1 }]\n"
               "actor = [{ name = \"cart\", presence = [{ at_s = 0.0, present = false }] }]\n");
    Keys keys = half_size(changes);
    keys.insert({{"sim.scenario", quoted(scratch_ / "scenario.toml")},
                 {"stage.localize.units", "60"},  // 13 are shipped, with which it searches for seconds more
                 {"localization.start.turn_radps", "0.78"},
                 {"motion.max_turn_radps", "0.78"}});
    write_text(scratch_ / "robot.toml", extended(CGSR_SOURCE_DIR "/config/robots/sim-home-anywhere.toml", keys));
    return scratch_ / "robot.toml";
  }

  ScratchFolder scratch_;
};

TEST_F(RunAnywhere, FindsItsFirstPoseByTurningAndDrivesOn) {
  const auto outcome =
      run_cgsr({"run", "--config", robot(), "--duration", "16", "--seed", "3", "--json", scratch_ / "run.json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const auto summary = nlohmann::json::parse(read_text(scratch_ / "run.json"));
  std::vector<std::string> phases;
  for (const auto& event : summary["events"]) {
    if (event["source"] == "first pose") phases.push_back(event["state"]);
  }
  EXPECT_EQ(phases, (std::vector<std::string>{"comparing", "trying", "settling", "found"}));
  EXPECT_GT(summary["pose"]["images"], 30) << "the rest of the run says nothing";
  EXPECT_LE(summary["pose"]["worst_cm"], 5.0);
  EXPECT_LE(summary["pose"]["worst_deg"], 1.5);
  EXPECT_GT(summary["outputs"]["decision"]["images"]["state"]["on its way"], 30) << "its task waits for ever";
}

// Somebody carried it elsewhere while it was off.
TEST_F(RunAnywhere, LostForLongByTheLastRunsPoseItFindsItselfAndDrivesOn) {
  write_text(scratch_ / "last.csv", "tx,ty,tz,qw,qx,qy,qz\n1.2,3.2,0,1,0,0,0\n");
  const auto outcome = run_cgsr(
      {"run", "--config",
       robot({{"localization.start.file", quoted(scratch_ / "last.csv")}, {"localization.start.again_after_s", "1"}}),
       "--duration", "16", "--seed", "3", "--json", scratch_ / "run.json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output + outcome.errors, HasSubstr("seeks its pose, once it is lost for long, among"));
  const auto summary = nlohmann::json::parse(read_text(scratch_ / "run.json"));
  std::vector<std::string> phases;
  for (const auto& event : summary["events"]) {
    EXPECT_NE(event["source"], "first pose");
    if (event["source"] == "new pose") phases.push_back(event["state"]);
  }
  EXPECT_EQ(phases, (std::vector<std::string>{"turning", "comparing", "trying", "settling", "found"}));
  EXPECT_GT(summary["pose"]["images"], 30) << "the rest of the run says nothing";
  EXPECT_LE(summary["pose"]["worst_cm"], 5.0);
  EXPECT_LE(summary["pose"]["worst_deg"], 1.5);
  EXPECT_GT(summary["outputs"]["decision"]["images"]["state"]["on its way"], 30) << "its task waits for ever";
  EXPECT_THAT(read_text(scratch_ / "last.csv"), AllOf(HasSubstr("tx,ty,tz"), Not(HasSubstr("1.2,3.2,0,1"))))
      << "it knew its pose at its end";
}

TEST_F(RunAnywhere, RefusesAFileWithWhichItCannotBe) {
  const auto without_map = run_cgsr({"run", "--config", robot({{"localization.map", "\"\""}}), "--duration", "1"});
  EXPECT_NE(without_map.exit_code, 0);
  const auto few = run_cgsr({"run", "--config", robot({{"stage.localize.units", "5"}}), "--duration", "1"});
  EXPECT_NE(few.exit_code, 0);
  EXPECT_THAT(few.errors, HasSubstr("stage.localize.units = 5: localization.start.anywhere needs at least 6"));
  const auto negative = run_cgsr({"run", "--config", robot({{"localization.start.again_after_s", "-1"}})});
  EXPECT_NE(negative.exit_code, 0);
  EXPECT_THAT(negative.errors, HasSubstr("localization.start.again_after_s = -1 is not in 0..3600 s"));
}

}  // namespace
}  // namespace cgsr::app::testing
