// The files in config/ that the project ships.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/config/canonical.h"
#include "platform/config/catalogue.h"
#include "platform/config/reader.h"
#include "src/config/listing.h"
#include "src/config/load.h"
#include "src/config/starter.h"
#include "tests/support/scratch_folder.h"

namespace cgsr::config {
namespace {

std::vector<std::filesystem::path> robot_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(CGSR_SOURCE_DIR "/config/robots")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  return files;
}

TEST(ShippedRobots, AreShortAndGood) {
  ASSERT_FALSE(robot_files().empty());
  for (const auto& file : robot_files()) {
    const auto robot = load_robot(file);
    EXPECT_TRUE(robot) << robot.error().message;
    std::ifstream text(file);
    const auto lines = std::count(std::istreambuf_iterator<char>(text), {}, '\n');
    EXPECT_GT(lines, 0) << file;
    EXPECT_LE(lines, 60) << file;
  }
}

// Every line of a shipped file says something: no value that is the default anyway.
TEST(ShippedRobots, NameOnlyWhatDiffersFromTheDefaults) {
  const auto defaults = catalogue(Robot());
  for (const auto& file : robot_files()) {
    const auto robot = load_robot(file);
    ASSERT_TRUE(robot) << robot.error().message;
    const auto sections = catalogue(*robot);
    for (std::size_t i = 0; i < sections.size(); ++i) {
      for (std::size_t j = 0; j < sections[i].entries.size(); ++j) {
        const std::string path = key_path(sections[i], sections[i].entries[j]);
        if (robot->provenance.origins.count(path) == 0) continue;
        EXPECT_NE(sections[i].entries[j].value, defaults[i].entries[j].value) << file << ": " << path;
      }
    }
  }
}

// What takes effect does not depend on where the checkout lies or how the file is named.
TEST(ShippedRobots, HaveTheSameHashElsewhere) {
  const test::ScratchFolder folder;
  const std::filesystem::path elsewhere = folder / "a/b";
  std::filesystem::create_directories(elsewhere);
  std::filesystem::copy(CGSR_SOURCE_DIR "/config/robots", elsewhere / "robots");
  for (const auto& file : robot_files()) {
    const auto here = load_robot(file);
    const auto there = load_robot(elsewhere / "robots" / file.filename());
    ASSERT_TRUE(here && there);
    EXPECT_EQ(hash(*there), hash(*here)) << file;
    EXPECT_EQ(canonical(*here).find(CGSR_SOURCE_DIR), std::string::npos) << file;
  }
}

TEST(Starter, ARobotForARecordingNeedsTwelveLines) {
  const std::string text =
      "camera.replay.path = \"walk.mp4\"\n"
      "[camera.pinhole]\n"
      "fx_px = 600.0\n"
      "fy_px = 600.0\n"
      "[run.learn]\n"
      "x_px = 280\n"
      "y_px = 180\n"
      "width_px = 80\n"
      "height_px = 120\n"
      "[motion]\n"
      "armed_at_start = true\n"
      "max_forward_mps = 0.2\n";
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 12);
  const test::ScratchFolder folder;
  const auto file = folder / "twelve_lines.toml";
  std::ofstream(file) << text;
  const auto robot = load_robot(file);
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_EQ(robot->camera.replay.path, (file.parent_path() / "walk.mp4").string());
  EXPECT_EQ(robot->provenance.origins.size(), 9u);
}

TEST(Starter, WhatIsWrittenIsAShortGoodFile) {
  for (const std::string_view text : {recording_starter(), webcam_starter()}) {
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 40);
    const test::ScratchFolder folder;
    const auto file = folder / "starter.toml";
    std::ofstream(file) << text;
    const auto robot = load_robot(file);
    ASSERT_TRUE(robot) << robot.error().message;
    EXPECT_FALSE(robot->run.learn.empty());
    EXPECT_EQ(robot->camera.replay.path.empty(), robot->real_camera());
  }
}

TEST(Starter, ARobotForAWebcamNeedsTwelveLines) {
  std::ifstream text(CGSR_SOURCE_DIR "/config/robots/webcam.toml");
  EXPECT_LE(std::count(std::istreambuf_iterator<char>(text), {}, '\n'), 12);
  const auto robot = load_robot(CGSR_SOURCE_DIR "/config/robots/webcam.toml");
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_TRUE(robot->real_camera());
  EXPECT_FALSE(robot->motion.armed_at_start);
}

// What runs in stamps' time has no place for devices that keep their own.
TEST(RealDevices, NeedThreadsAndTheClock) {
  for (const std::string_view device :
       {"camera.kind = \"v4l2\"", "base = {kind = \"rmp\", can = \"socketcan\"}", "switches.kind = \"gpiod\""}) {
    const test::ScratchFolder folder;
    const auto file = folder / "robot.toml";
    std::ofstream(file) << device << "\ncamera.replay.pace = \"own_rate\"\n";
    const auto lock_step = load_robot(file);
    ASSERT_FALSE(lock_step) << device;
    EXPECT_THAT(lock_step.error().message, testing::HasSubstr("need run.pace = \"live\""));
    std::ofstream(file, std::ios::app) << "run.pace = \"live\"\n";
    const auto live = load_robot(file);
    EXPECT_TRUE(live) << live.error().message;
  }
}

TEST(GivenLamp, NeedsAMapAndNoProbes) {
  Robot robot;
  robot.shade.lamp.given = true;
  EXPECT_THAT(robot.inconsistency(), testing::HasSubstr("localization.map"));
  robot.localization.map = "map.obj";
  robot.localization.camera = "camera.yaml";
  robot.localization.mount = "mount.toml";
  EXPECT_EQ(robot.inconsistency(), "");
  robot.probes.board.probes = 2;
  EXPECT_THAT(robot.inconsistency(), testing::HasSubstr("they find the lamp"));
}

TEST(Listing, ShowsEveryValueWithItsOrigin) {
  const auto robot = load_robot(CGSR_SOURCE_DIR "/config/robots/sim-home-lamp.toml");
  ASSERT_TRUE(robot) << robot.error().message;
  const std::string text = show_text(*robot);
  EXPECT_THAT(text, testing::StartsWith("# configuration " + hash(*robot)));
  EXPECT_THAT(text, testing::ContainsRegex("max_pose_loss_s +=  ?4 +# .*sim-home-lamp.toml:[0-9]+\n"));
  EXPECT_THAT(text, testing::ContainsRegex("distance_m +=  ?1.8 +# .*sim-segway.toml:[0-9]+\n"));
  EXPECT_THAT(text, testing::ContainsRegex("goal_timeout_s +=  ?0.15 +# default\n"));
  EXPECT_THAT(text, testing::ContainsRegex("model +=  ?\"../models/orange-ball.cgsrmodel\" +# "));

  const auto document = Document::parse(text, "shown.toml");
  ASSERT_TRUE(document) << document.error().message;
  Robot shown;
  const auto read_back = Reader{Layers(*document)}.read_sections(shown);
  ASSERT_TRUE(read_back) << read_back.error().message;
  EXPECT_EQ(canonical(shown), canonical(*robot)) << "what is shown means the same";
}

TEST(Listing, DiffNamesBothValuesAndTheirOrigins) {
  const auto lamp = load_robot(CGSR_SOURCE_DIR "/config/robots/sim-home-lamp.toml");
  ASSERT_TRUE(lamp) << lamp.error().message;
  const std::string text = diff_text(*lamp, Robot());
  EXPECT_THAT(text,
              testing::ContainsRegex("task.lamp.max_pose_loss_s = 4 \\(.*lamp.toml:[0-9]+\\), 2 \\(default\\)\n"));
  EXPECT_THAT(text, testing::HasSubstr("41 of "));
  EXPECT_THAT(diff_text(*lamp, *lamp), testing::StartsWith("0 of "));
}

TEST(Listing, KeysAreFoundByAnyPartOfTheirPath) {
  EXPECT_THAT(keys_text("motion.max_forward"),
              testing::AllOf(testing::HasSubstr(
                                 "motion.max_forward_mps = 0.3 m/s  (0..1.5 m/s)\n    The largest forward speed.\n"),
                             testing::Not(testing::HasSubstr("follow"))));
  EXPECT_THAT(keys_text(""),
              testing::AllOf(testing::HasSubstr("run.pace"), testing::HasSubstr("motion.keep_in.max_y_m")));
  EXPECT_EQ(keys_text("colour"), "");
}

TEST(ShippedRobots, AreSlowNeverBackwardsAndKeptIn) {
  for (const auto& file : robot_files()) {
    const auto robot = load_robot(file);
    ASSERT_TRUE(robot) << robot.error().message;
    EXPECT_LE(robot->motion.max_forward_mps, 0.5) << file;
    EXPECT_EQ(robot->motion.max_backward_mps, 0.0) << file << ": it is blind backwards";
    EXPECT_LE(robot->motion.goal_timeout_s, 0.150) << file;
    EXPECT_LE(robot->motion.feedback_timeout_s, 0.100) << file;
    EXPECT_TRUE(robot->motion.keep_in.enabled) << file;
  }
}

// A command takes a whole robot's file as well as one with just its sections, and then a robot's own demands do not matter.
TEST(Sections, AreTakenFromAWholeRobotsFileAndFromOneOfTheirOwn) {
  const auto lamp = load_light(CGSR_SOURCE_DIR "/config/robots/sim-home-lamp.toml");
  ASSERT_TRUE(lamp) << lamp.error().message;
  EXPECT_EQ(lamp->probes.board.place_sigma_m, 0.001);
  EXPECT_THAT(lamp->mount_file, testing::EndsWith("config/maps/home/lamp-robot.toml"));
  const auto board = load_light(CGSR_SOURCE_DIR "/config/illumination/lamp-robot.toml");
  ASSERT_TRUE(board) << board.error().message;
  EXPECT_EQ(board->probes.board.probes, 2);
  const auto pose = load_localization(CGSR_SOURCE_DIR "/config/robots/sim-home-lamp.toml");
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_EQ(pose->tracker.max_missed_corrections, 450);
  const auto colour = load_color(CGSR_SOURCE_DIR "/config/localization/floor.toml");
  ASSERT_TRUE(colour) << colour.error().message;
  EXPECT_EQ(hash(*colour), hash(Color()));
}

TEST(ShippedLocalization, AreGoodAndWithoutAFileItIsTheFreeOne) {
  const std::filesystem::path folder = CGSR_SOURCE_DIR "/config/localization";
  const auto free = load_localization(folder / "free.toml");
  ASSERT_TRUE(free) << free.error().message;
  EXPECT_EQ(canonical(*free), canonical(*load_localization({})));
  EXPECT_FALSE(free->tracker.floor);
  const auto floor = load_localization(folder / "floor.toml");
  ASSERT_TRUE(floor) << floor.error().message;
  EXPECT_TRUE(floor->tracker.floor);
}

}  // namespace
}  // namespace cgsr::config
