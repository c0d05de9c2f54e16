// Algorithm 5.2 where something is wrong or lamps are switched to make sure: the robot's program in the simulated home, images of half the size.
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace cgsr::app::testing {
namespace {

using ::testing::HasSubstr;

class LampRun : public ::testing::Test {
 protected:
  /// The lamp robot stands where the living lamp shows on its probes, and may turn from half a second on.
  LampRun() {
    scenario_ = "world = \"" CGSR_SOURCE_DIR
                "/config/worlds/home.toml\"\n"
                "robot = \"lamp robot\"\n"
                "start = { given = true, x_m = 4.6, y_m = 3.2 }\n"
                "camera = { edge_samples = 1 }\n"
                "line = [{ name = \"arming\", input = true }, { name = \"living lamp\" }, { name = \"probe lamp\" }, "
                "{ name = \"reading lamp\" }]\n"
                "wall_switch = [{ lamp_line = \"living lamp\" }]\n"
                "light = [{ lamp = \"living lamp\", radius_m = 0.05 }]\n"
                "actor = [{ name = \"cart\", presence = [{ at_s = 0.0, present = false }] }]\n"
                "lamp = [{ name = \"probe lamp\", carried_by = \"lamp robot\", position_m = [0.3, -0.62, 1.75], "
                "radius_m = 0.02, visible = false, lumens = 250.0, switch = \"probe lamp\" },\n"
                "  { name = \"reading lamp\", position_m = [4.2, 1.4, 2.3], radius_m = 0.05, lumens = 700.0, "
                "switch = \"reading lamp\" }]\n";
    robot_ = half_size({{"sim.scenario", quoted("scenario.toml")},
                        {"localization.start.x_m", "4.6"},
                        {"localization.start.y_m", "3.2"},
                        {"task.lamp.min_locate_s", "0.3"},
                        {"task.lamp.max_locate_s", "0.6"},
                        {"task.lamp.max_probes_loss_s", "0.4"}});
  }

  void change(const Keys& changes) {
    for (const auto& [key, value] : changes) robot_[key] = value;
  }

  void write_robot() {
    write_text(scratch_ / "robot.toml", extended(CGSR_SOURCE_DIR "/config/robots/sim-home-lamp.toml", robot_));
  }

  nlohmann::json run(const std::string& duration_s) {
    write_text(scratch_ / "scenario.toml", scenario_);
    write_robot();
    const auto outcome = run_cgsr({"run", "--config", scratch_ / "robot.toml", "--duration", duration_s, "--arm",
                                   "--json", scratch_ / "run.json"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    errors_ = outcome.errors;
    return outcome.exit_code == 0 ? nlohmann::json::parse(read_text(scratch_ / "run.json")) : nlohmann::json{};
  }

  static std::vector<nlohmann::json> events_of(const nlohmann::json& summary, const std::string& source) {
    std::vector<nlohmann::json> events;
    for (const auto& event : summary.at("events")) {
      if (event["source"] == source) events.push_back(event);
    }
    return events;
  }
  static nlohmann::json last_event(const nlohmann::json& summary, const std::string& source) {
    const auto events = events_of(summary, source);
    return events.empty() ? nlohmann::json{{"state", "no event"}, {"reason", "no event"}} : events.back();
  }
  static int images_by_probes(const nlohmann::json& summary, const std::string& outcome) {
    return summary["outputs"]["lamp"]["images"]["probes"].value(outcome, 0);
  }

  /// It tracks in ambient light, and no image had a mask.
  static void expect_no_mask(const nlohmann::json& summary, const std::string& reason) {
    ASSERT_FALSE(events_of(summary, "task").empty());
    EXPECT_EQ(last_event(summary, "task")["state"], "tracking, ambient light only") << summary["events"];
    EXPECT_EQ(last_event(summary, "task")["reason"], reason);
    EXPECT_EQ(summary["outputs"]["lamp"]["images"]["lamp_x_m"], 0) << "a lamp is known";
    EXPECT_FALSE(summary["outputs"]["shade"]["images"]["shade"].contains("masked"));
  }

  ScratchFolder scratch_;
  std::string scenario_;
  Keys robot_;
  std::string errors_;
};

using LampRunFault = LampRun;

TEST_F(LampRun, ALampThatAnswersChecksTheProbesAndProvesTheShadows) {
  change({{"switches.probe_lamp_line", quoted("probe lamp")}, {"switches.room_lamp_line", quoted("living lamp")}});
  const auto summary = run("4.5");
  EXPECT_EQ(last_event(summary, "check by the probe lamp")["state"], "passed") << summary["events"];
  EXPECT_EQ(last_event(summary, "check by the room lamp")["state"], "passed") << summary["events"];
  const auto& switchings = summary["switchings"];
  ASSERT_EQ(switchings.size(), 4U);
  for (const auto& one : switchings) {
    EXPECT_EQ(one["done"], true);
    EXPECT_GE(one["answered_s"], one["requested_s"]);
  }
  EXPECT_EQ(switchings[3]["on"], false) << "as it was before";
  EXPECT_GT(images_by_probes(summary, "a lamp is switched"), 0);
  bool backed_off = false;
  for (const auto& step : events_of(summary, "task"))
    backed_off = backed_off || step["reason"] == "the shadows are the room lamp's";
  EXPECT_TRUE(backed_off) << summary["events"];
  EXPECT_EQ(summary["frames"]["late"], 0);
}

// Algorithm 5.2 from the first shadow to the masked state: it locates the lamp, backs off a little, waits for the masks and tracks with them.
TEST_F(LampRun, LocatesTheLampBacksOffAndTracksWithTheMask) {
  change({{"task.lamp.back_off_m", "0.4"}});
  const auto summary = run("9");
  ASSERT_FALSE(events_of(summary, "task").empty());
  EXPECT_EQ(last_event(summary, "task")["state"], "tracking") << summary["events"];
  EXPECT_GT(summary["outputs"]["shade"]["images"]["shade"]["masked"], 10) << summary["outputs"];
  EXPECT_LT(summary["light"]["last_cm"], 20.0) << summary["light"];
}

TEST_F(LampRunFault, ALineThatDoesNotAnswerIsNamedAndItTracksWithoutAMask) {
  change({{"switches.probe_lamp_line", quoted("probe lamp")}});
  scenario_ += "line_event = [{ what = \"no_answer\", line = \"probe lamp\" }]\n";
  const auto summary = run("1.8");
  EXPECT_EQ(summary["switchings"][0]["done"], false);
  EXPECT_THAT(summary["switchings"][0]["problem"].get<std::string>(), HasSubstr("'probe lamp'"));
  EXPECT_EQ(last_event(summary, "check by the probe lamp")["state"], "fault");
  EXPECT_EQ(last_event(summary, "check by the probe lamp")["reason"], "the switch does not answer");
  EXPECT_THAT(errors_, HasSubstr("the line does not answer"));
  EXPECT_EQ(last_event(summary, "task")["reason"], "a lamp does not switch");
  EXPECT_EQ(last_event(summary, "task")["state"], "tracking, ambient light only");
}

TEST_F(LampRunFault, ALineThatAnswersAndSwitchesNothingIsNamed) {
  change({{"switches.probe_lamp_line", quoted("probe lamp")}});
  scenario_ += "line_event = [{ what = \"stuck\", line = \"probe lamp\" }]\n";
  const auto summary = run("3.0");
  EXPECT_EQ(last_event(summary, "check by the probe lamp")["reason"], "the lamp did not switch");
  EXPECT_EQ(last_event(summary, "task")["state"], "tracking, ambient light only");
}

// What the line switches is another lamp than the one whose shadows the probes show.
TEST_F(LampRunFault, AShadowThatStaysIsNotTheRoomLampsAndItTracksWithoutAMask) {
  change({{"switches.room_lamp_line", quoted("reading lamp")}});
  const auto summary = run("3.2");
  EXPECT_EQ(events_of(summary, "check by the room lamp").size(), 1U) << summary["events"];
  EXPECT_EQ(last_event(summary, "check by the room lamp")["state"], "failed") << summary["events"];
  EXPECT_EQ(last_event(summary, "task")["reason"], "the shadows are not the room lamp's");
  EXPECT_EQ(last_event(summary, "task")["state"], "tracking, ambient light only");
  EXPECT_GT(images_by_probes(summary, "not the room lamp's shadow"), 0);
}

TEST_F(LampRunFault, ALineThatTheRobotDoesNotHaveStopsTheStart) {
  change({{"switches.room_lamp_line", quoted("moon")}});
  write_text(scratch_ / "scenario.toml", scenario_);
  write_robot();
  const auto outcome = run_cgsr({"run", "--config", scratch_ / "robot.toml", "--duration", "1"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("there is no line 'moon'"));
}

TEST_F(LampRunFault, ProbesThatAreNotInView) {
  replace(scenario_, "robot = \"lamp robot\"", "robot = \"robot\"");
  const auto summary = run("0.8");
  expect_no_mask(summary, "the probe board cannot be read");
  EXPECT_GT(images_by_probes(summary, "board and probes not found"), 0);
}

TEST_F(LampRunFault, AConeThatIsMissing) {
  auto world = read_text(CGSR_SOURCE_DIR "/config/worlds/home.toml");
  replace(world, "has_board = true", "has_board = true\n\n[robot.board]\ncones = 1");
  write_text(scratch_ / "world.toml", world);
  replace(scenario_, CGSR_SOURCE_DIR "/config/worlds/home.toml", scratch_ / "world.toml");
  const auto summary = run("0.8");
  expect_no_mask(summary, "the probe board cannot be read");
  EXPECT_GT(images_by_probes(summary, "a cone is missing"), 0);
}

TEST_F(LampRunFault, ABoardThatIsBrighterThanTheCameraHolds) {
  replace(scenario_, "radius_m = 0.05 }]",
          "radius_m = 0.05, script = [{ at_s = 0.0, factor = [40.0, 40.0, 40.0] }] }]");
  const auto summary = run("0.8");
  expect_no_mask(summary, "the probe board cannot be read");
  EXPECT_GT(images_by_probes(summary, "board saturated"), 0);
}

TEST_F(LampRunFault, ACalibrationOfAnotherCamera) {
  auto camera = read_text(CGSR_SOURCE_DIR "/config/maps/home/camera.yaml");
  replace(camera, "image_height: 480", "image_height: 360");
  write_text(scratch_ / "camera.yaml", camera);
  change({{"localization.camera", quoted("camera.yaml")}});
  const auto summary = run("0.4");
  expect_no_mask(summary, "no probe board");
  ASSERT_EQ(summary["problems"].size(), 1U);
  EXPECT_THAT(summary["problems"][0].get<std::string>(), HasSubstr("another camera's file?"));
}

TEST_F(LampRunFault, ACalibrationOfAnotherLens) {
  auto camera = read_text(CGSR_SOURCE_DIR "/config/maps/home/camera.yaml");
  replace(camera, "data: [602", "data: [902");
  write_text(scratch_ / "camera.yaml", camera);
  change({{"localization.camera", quoted("camera.yaml")}});
  const auto summary = run("0.4");
  expect_no_mask(summary, "no probe board");
  EXPECT_THAT(summary["problems"][0].get<std::string>(), HasSubstr("do not belong together"));
}

TEST_F(LampRunFault, ALampThatHangsBelowTheBoard) {
  change({{"lamp.height_m", "0.8"}});
  const auto summary = run("0.4");
  expect_no_mask(summary, "no probe board");
  ASSERT_EQ(summary["problems"].size(), 1U);
  EXPECT_THAT(summary["problems"][0].get<std::string>(), HasSubstr("lamp: "));
  EXPECT_THAT(errors_, HasSubstr("it tracks without a mask"));
}

}  // namespace
}  // namespace cgsr::app::testing
