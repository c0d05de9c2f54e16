// cgsr sim as a user meets it: every test runs the program.
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/app/program.h"

namespace cgsr::sim {
namespace {

using app::testing::Outcome;
using app::testing::read_text;
using app::testing::run_cgsr;
using app::testing::ScratchFolder;
using app::testing::write_text;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

const std::string kRoom = R"(name = "room"
ambient = { illuminance_lux = [15, 15, 15] }
[[material]]
name = "grey"
[[material]]
name = "orange"
albedo = [0.9, 0.4, 0.1]
[[shape]]
name = "floor"
kind = "rectangle"
material = "grey"
size_m = [8, 8, 0]
[[shape]]
name = "box"
material = "grey"
position_m = [2.0, 0.5, 0]
size_m = [0.4, 0.4, 0.6]
[[ball]]
name = "ball"
material = "orange"
walk = { stop = [{ at_m = [3.5, -0.3, 0] }, { at_m = [3.5, -1.3, 0] }] }
[[lamp]]
name = "ceiling"
switch = "light"
position_m = [1.0, 0.2, 2.5]
[[robot]]
name = "looker"
has_board = true
camera_down_deg = 20
[[view]]
name = "side"
from_m = [2, -4, 1]
to_m = [2, 0, 0.3]
)";

class SimTool : public testing::Test {
 protected:
  SimTool() { app::testing::write_text(scratch_ / "room.toml", kRoom); }

  Outcome render(const std::vector<std::string>& more, const std::string& picture = "out.png") {
    std::vector<std::string> words{"render",  "--world",  scratch_ / "room.toml", "--size",
                                   "160x120", "--output", scratch_ / picture};
    words.insert(words.end(), more.begin(), more.end());
    return run_cgsr(words);
  }

  // What one picture is (its hash: failures should not print pictures), or a failure.
  std::size_t picture(const std::vector<std::string>& more) {
    const Outcome outcome = render(more);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return std::hash<std::string>()(read_text(scratch_ / "out.png"));
  }

  void refused(const std::vector<std::string>& more, const std::string& reason) {
    const Outcome outcome = render(more, "refused.png");
    EXPECT_NE(outcome.exit_code, 0);
    EXPECT_THAT(outcome.errors, HasSubstr(reason));
    EXPECT_FALSE(fs::exists(scratch_ / "refused.png")) << "nothing half-done stays behind";
  }

  ScratchFolder scratch_;
};

using SimToolFault = SimTool;

TEST_F(SimTool, RendersWhatTheRobotSees) {
  const std::size_t first = picture({});
  const cv::Mat image = cv::imread(scratch_ / "out.png");
  EXPECT_EQ(image.size(), cv::Size(160, 120));
  EXPECT_EQ(picture({}), first) << "the same command, the same bytes";
  EXPECT_EQ(picture({"--robot", "looker"}), first);
  EXPECT_EQ(picture({"--threads", "1"}), first);
  EXPECT_NE(picture({"--seed", "2"}), first);
  EXPECT_NE(picture({"--time", "1.5"}), first);
  EXPECT_EQ(picture({"--no-noise", "--seed", "1"}), picture({"--no-noise", "--seed", "2"}));
}

// A pose, and the place and direction that are that pose, show the same.
TEST_F(SimTool, RendersFromAnyPose) {
  const std::size_t by_view = picture({"--view", "side"});
  EXPECT_EQ(picture({"--from", "2,-4,1", "--to", "2,0,0.3"}), by_view);
  // Looks along +y, level: camera z = world y, camera y = -world z, camera x = world x.
  const std::size_t level = picture({"--from", "2,-4,0.5", "--to", "2,0,0.5"});
  EXPECT_EQ(picture({"--pose", "2,-4,0.5,0.70710678118654757,-0.70710678118654757,0,0", "--no-noise"}),
            picture({"--from", "2,-4,0.5", "--to", "2,0,0.5", "--no-noise"}));
  EXPECT_NE(level, by_view);
}

TEST_F(SimTool, SwitchesLamps) {
  picture({"--view", "side", "--no-noise"});
  const double lit = cv::mean(cv::imread(scratch_ / "out.png"))[1];
  picture({"--view", "side", "--no-noise", "--off", "light"});
  EXPECT_LT(cv::mean(cv::imread(scratch_ / "out.png"))[1], 0.97 * lit);
}

TEST_F(SimTool, WritesWhatIsThere) {
  picture({"--truth", scratch_ / "truth"});
  const cv::Mat depth = cv::imread(scratch_ / "truth/depth.png", cv::IMREAD_UNCHANGED);
  EXPECT_EQ(depth.type(), CV_16U);
  EXPECT_EQ(depth.size(), cv::Size(160, 120));
  const cv::Mat parts = cv::imread(scratch_ / "truth/parts.png", cv::IMREAD_UNCHANGED);
  EXPECT_THAT(read_text(scratch_ / "truth/parts.csv"), HasSubstr("3,\"ball\",\"ball\""));
  EXPECT_THAT(read_text(scratch_ / "truth/truth.csv"),
              AllOf(HasSubstr("ball.visible_px"), HasSubstr("probe1.shadow_u_px")));
  const cv::Mat possibly = cv::imread(scratch_ / "truth/possibly_shaded.png", cv::IMREAD_UNCHANGED);
  const cv::Mat surface = cv::imread(scratch_ / "truth/surface_shaded.png", cv::IMREAD_UNCHANGED);
  EXPECT_GE(cv::countNonZero(possibly), cv::countNonZero(surface));
  EXPECT_GT(cv::countNonZero(possibly), 0);
  EXPECT_GT(cv::countNonZero(parts == 3), 10) << "the ball";
}

TEST_F(SimTool, ExportsAMapAndACalibratedCopy) {
  const auto exported = [&](const std::string& folder, const std::vector<std::string>& more) {
    std::vector<std::string> words{"export", "--world", scratch_ / "room.toml", "--output", scratch_ / folder};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run_cgsr(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  };
  exported("a", {"--seed", "4"});
  exported("b", {"--seed", "4"});
  exported("c", {"--seed", "5"});
  for (const char* file : {"map.obj", "map.mtl", "calibrated/map.obj", "calibrated/map.mtl", "calibrated/camera.yaml",
                           "calibrated/robot.toml"}) {
    const std::string text = read_text(scratch_ / "a" + "/" + file);
    EXPECT_FALSE(text.empty()) << file;
    EXPECT_EQ(read_text(scratch_ / "b" + "/" + file), text) << file;
  }
  EXPECT_EQ(read_text(scratch_ / "c/map.obj"), read_text(scratch_ / "a/map.obj")) << "the truth has no seed";
  EXPECT_NE(read_text(scratch_ / "c/calibrated/camera.yaml"), read_text(scratch_ / "a/calibrated/camera.yaml"));
  EXPECT_THAT(read_text(scratch_ / "a/calibrated/robot.toml"),
              AllOf(HasSubstr("apex_m"), HasSubstr("quaternion_wxyz")));
}

TEST_F(SimTool, SaysWhatIsInAWorld) {
  const Outcome outcome = run_cgsr({"info", "--world", scratch_ / "room.toml"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output,
              AllOf(HasSubstr("room: a map of 7 surfaces and 16 edges"), HasSubstr("robot 'looker', with probe board"),
                    HasSubstr("view 'side'"), HasSubstr("line 'light'"), HasSubstr("actor 'ball'")));
}

TEST_F(SimToolFault, WhatACommandLineGetsWrongIsNamed) {
  refused({"--pose", "1,2,3"}, "'1,2,3' is not a pose: expected tx,ty,tz,qw,qx,qy,qz");
  refused({"--pose", "1,2,3,0.5,0,0,0"}, "its quaternion qw,qx,qy,qz has the length 0.5, not 1");
  refused({"--pose", "nan,2,3,1,0,0,0"}, "is not a pose");
  refused({"--pose", "1,2,3,1,0,0,0,9"}, "is not a pose");
  refused({"--pose", "1e7,2,3,1,0,0,0"}, "is it in metres?");
  refused({"--from", "1,2", "--to", "0,0,0"}, "'1,2' is not a place: expected X,Y,Z in metres");
  refused({"--from", "1,2,3", "--to", "1,2,0"}, "straight up or down");
  refused({"--from", "1,2,3"}, "--to");
  refused({"--view", "top"}, "has no view 'top'; it has 'side'");
  refused({"--robot", "walker"}, "there is no robot 'walker'; there are 'looker'");
  refused({"--lamp", "sun"}, "there is no lamp 'sun'; there are 'ceiling'");
  refused({"--on", "heating"}, "no lamp is switched by a line 'heating'; there are 'light'");
  refused({"--time", "-1"}, "--time");
  refused({"--edge-samples", "3"}, "--edge-samples");
  EXPECT_EQ(render({"--frobnicate"}).exit_code, 2);
}

TEST_F(SimToolFault, ALampOnARobotThatIsNotInThePictureIsNotSwitchedOn) {
  const Outcome outcome = run_cgsr({"render", "--world", "people", "--from", "0.8,0,1.45", "--to", "2.6,0,1.4", "--on",
                                    "face light", "--output", scratch_ / "refused.png"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors,
              HasSubstr("the lamp of line 'face light' is carried by 'robot', which is not in this picture"));
  const Outcome own = run_cgsr(
      {"render", "--world", "people", "--on", "face light", "--size", "160x120", "--output", scratch_ / "own.png"});
  EXPECT_EQ(own.exit_code, 0) << own.errors;
  const Outcome off =
      run_cgsr({"render", "--world", "people", "--from", "0.8,0,1.45", "--to", "2.6,0,1.4", "--size", "160x120", "--on",
                "face light", "--off", "face light", "--output", scratch_ / "off.png"});
  EXPECT_EQ(off.exit_code, 0) << off.errors;
}

TEST_F(SimToolFault, SizesThatCannotBeAreRefused) {
  for (const char* size : {"0x0", "160", "161x120", "160x", "1e3x100", "99999x99999", "-160x120", "160x120x3"}) {
    const Outcome outcome = run_cgsr({"render", "--world", scratch_ / "room.toml", "--output", scratch_ / "refused.png",
                                      fmt::format("--size={}", size)});
    EXPECT_EQ(outcome.exit_code, 1) << size;
    EXPECT_THAT(outcome.errors, HasSubstr(fmt::format("'{}' is not a size: expected WIDTHxHEIGHT", size)));
  }
}

TEST_F(SimToolFault, WorldsThatCannotBeAreRefused) {
  const auto errors = [&](const std::string& world) {
    const Outcome outcome = run_cgsr({"render", "--world", world, "--output", scratch_ / "refused.png"});
    EXPECT_EQ(outcome.exit_code, 1);
    return outcome.errors;
  };
  EXPECT_THAT(errors("hme"),
              AllOf(HasSubstr("there is no world 'hme'; there are"), HasSubstr("home"), HasSubstr("spl-field")));
  EXPECT_THAT(errors(scratch_ / "none.toml"), HasSubstr("there is no such file"));
  EXPECT_THAT(errors(scratch_.path().string()), HasSubstr("not a file"));
  app::testing::write_text(scratch_ / "bad.toml",
                           kRoom + "[[lamp]]\nname = \"buried\"\nposition_m = [2.0, 0.5, 0.3]\n");
  EXPECT_THAT(errors(scratch_ / "bad.toml"), HasSubstr("lamp 'buried' is inside 'box'"));
  app::testing::write_text(scratch_ / "bytes.toml", std::string("\0\xff\xfe", 3));
  EXPECT_THAT(errors(scratch_ / "bytes.toml"), HasSubstr("bytes.toml"));
}

TEST_F(SimToolFault, PlacesThatCannotBeWrittenAreNamed) {
  EXPECT_THAT(render({}, "nowhere/out.png").errors, HasSubstr("cannot be written: No such file or directory"));
  EXPECT_THAT(render({}, "out.jpg").errors, HasSubstr("pictures are written as .png"));
  app::testing::write_text(scratch_ / "file", "in the way");
  EXPECT_THAT(render({"--truth", scratch_ / "file"}).errors, HasSubstr("file"));
  const Outcome outcome = run_cgsr({"export", "--world", scratch_ / "room.toml", "--output", scratch_ / "file"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("file"));
  EXPECT_THAT(run_cgsr({"export", "--world", scratch_ / "room.toml", "--output", scratch_ / "e", "--errors=-1"}).errors,
              HasSubstr("not in 0..20"));
}

TEST(SimRun, PlaysAScenarioWithARobotThatNobodyCommands) {
  const ScratchFolder folder;
  write_text(folder / "room.toml", kRoom);
  write_text(folder / "play.toml", "world = \"room.toml\"\nrobot = \"looker\"\nobject = \"ball\"\nends_at_s = 0.5\n");
  const auto played = run_cgsr({"run", "--scenario", folder / "play.toml", "--size", "64x48", "--truth",
                                folder / "truth.csv", "--video", folder / "play.avi"});
  ASSERT_EQ(played.exit_code, 0) << played.errors;
  EXPECT_THAT(played.output, HasSubstr("16 images"));
  const std::string truth = read_text(folder / "truth.csv");
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), 17) << "a head and a row an image";
  EXPECT_GT(fs::file_size(folder / "play.avi"), 1000U);
}

TEST(SimRunFault, SaysWhichScenariosThereAre) {
  const auto refused = run_cgsr({"run", "--scenario", "hoem-follow"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.errors, AllOf(HasSubstr("no scenario 'hoem-follow'"), HasSubstr("home-follow")));
}

}  // namespace
}  // namespace cgsr::sim
