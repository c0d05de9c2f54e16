// cgsr light as its user calls it: on a picture of the simulated home, with the robot's calibration measured with errors.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/program.h"

namespace cgsr::app::testing {
namespace {

using ::testing::HasSubstr;

class LightCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto exported =
        run_cgsr({"sim", "export", "--world", "home", "--robot", "lamp robot", "--output", scratch_ / "home"});
    ASSERT_EQ(exported.exit_code, 0) << exported.errors;
  }

  void photograph(const std::string& robot, const std::string& name) {
    std::filesystem::create_directories(std::filesystem::path(scratch_ / name).parent_path());
    const auto drawn = run_cgsr({"sim", "render", "--world", "home", "--robot", robot, "--output", scratch_ / name});
    ASSERT_EQ(drawn.exit_code, 0) << drawn.errors;
  }

  /// A picture of another world: the home with something of it replaced.
  void photograph_changed(const std::string& from, const std::string& to, const std::string& name) {
    std::string world = read_text(CGSR_SOURCE_DIR "/config/worlds/home.toml");
    const auto at = world.find(from);
    ASSERT_NE(at, std::string::npos);
    write_text(scratch_ / "world.toml", world.replace(at, from.size(), to));
    const auto drawn = run_cgsr(
        {"sim", "render", "--world", scratch_ / "world.toml", "--robot", "lamp robot", "--output", scratch_ / name});
    ASSERT_EQ(drawn.exit_code, 0) << drawn.errors;
  }

  Outcome light(const std::string& image, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{
        "light",   "--config",      config_, "--camera", camera_, "--mount", scratch_ / "home/calibrated/robot.toml",
        "--input", scratch_ / image};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_cgsr(arguments);
  }

  ScratchFolder scratch_;
  std::string config_ = CGSR_SOURCE_DIR "/config/illumination/lamp-robot.toml";
  std::string camera_ = scratch_ / "home/calibrated/camera.yaml";
};

using LightCommandFault = LightCommand;

TEST_F(LightCommand, FindsTheLampOfTheHome) {
  photograph("lamp robot", "probes.png");
  write_text(scratch_ / "pose.csv", "tx,ty,tz,qw,qx,qy,qz\n4.6,3.2,0,1,0,0,0\n");
  const auto outcome = light("probes.png", {"--pose", scratch_ / "pose.csv", "--csv", scratch_ / "lamp.csv"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const std::string rows = read_text(scratch_ / "lamp.csv");
  ASSERT_THAT(rows, HasSubstr("frame,found,reason,x,y,z,probes,sigma_m\n0,1,,"));
  std::array<double, 3> p{};
  ASSERT_EQ(std::sscanf(rows.c_str() + rows.find("0,1,,") + 5, "%lf,%lf,%lf", &p[0], &p[1], &p[2]), 3);
  // By the board of robot.toml, whose tips are stated with errors of 1 mm a coordinate: 2 cm each at the lamp.
  EXPECT_LT(std::hypot(p[0] - 6.0, p[1] - 3.2, p[2] - 2.75), 0.08) << rows;
}

// A pose that is known roughly makes a lamp that is known roughly.
TEST_F(LightCommand, TakesFromThePoseHowWellItIsKnown) {
  photograph("lamp robot", "images/0.png");
  photograph("lamp robot", "images/1.png");
  photograph("lamp robot", "images/2.png");
  const auto sigma_of = [&](const std::string& head, const std::string& tail) {
    const std::string row = "4.6,3.2,0,1,0,0,0" + tail + "\n";
    write_text(scratch_ / "pose.csv", "tx,ty,tz,qw,qx,qy,qz" + head + "\n" + row + row + row);
    const auto outcome = light("images", {"--pose", scratch_ / "pose.csv"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    const auto at = outcome.output.find("sigma (");
    EXPECT_NE(at, std::string::npos) << outcome.output;
    return at == std::string::npos ? 0.0 : std::stod(outcome.output.substr(at + 7));
  };
  const double least = sigma_of("", "");
  EXPECT_GT(least, 0.003);
  EXPECT_NEAR(sigma_of(",sigma_m,sigma_deg", ",0.001,0.01"), least, 1e-9) << "never better than [lamp] says";
  EXPECT_GT(sigma_of(",sigma_m,sigma_deg", ",0.1,0.3"), 0.05);
}

TEST_F(LightCommandFault, EachBadInputHasItsName) {
  photograph_changed("has_board = true", "has_board = true\n\n[robot.board]\ncones = 1", "one-cone.png");
  const auto one_cone = light("one-cone.png", {"--csv", scratch_ / "one-cone.csv"});
  EXPECT_THAT(one_cone.output, HasSubstr("1 images: a cone is missing"));
  EXPECT_EQ(one_cone.exit_code, 1) << "nothing is trusted in such an image, as the robot's own stage has it";
  EXPECT_THAT(one_cone.errors, HasSubstr("a cone is missing"));
  EXPECT_THAT(read_text(scratch_ / "one-cone.csv"), HasSubstr("0,0,a cone is missing,,,,,"));

  photograph_changed("lumens = 2600.0", "lumens = 100000.0", "bright.png");
  const auto bright = light("bright.png");
  EXPECT_EQ(bright.exit_code, 1);
  EXPECT_THAT(bright.errors, HasSubstr("board saturated"));

  photograph("lamp robot", "probes.png");
  const std::string right_camera = camera_;
  std::string yaml = read_text(camera_);
  yaml.replace(yaml.find("image_width: 640"), 16, "image_width: 800");
  camera_ = scratch_ / "other.yaml";
  write_text(camera_, yaml);
  const auto other = light("probes.png");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.errors, HasSubstr("is of a camera of 800x480"));

  yaml = read_text(right_camera);
  const auto focal = yaml.find("data: [6");
  ASSERT_NE(focal, std::string::npos);
  write_text(camera_, yaml.replace(focal, 8, "data: [9"));  // of the same size, but another lens
  EXPECT_THAT(light("probes.png").errors, HasSubstr("do not belong together"));

  camera_ = right_camera;
  std::string low = read_text(config_);
  low.replace(low.find("height_m = 2.75"), 15, "height_m = 0.80");
  config_ = scratch_ / "low.toml";
  write_text(config_, low);
  const auto below = light("probes.png");
  EXPECT_EQ(below.exit_code, 1);
  EXPECT_THAT(below.errors, HasSubstr("low.toml: "));
}

TEST_F(LightCommand, SaysWhyThereIsNoLamp) {
  photograph("robot", "no-board.png");
  const auto outcome = light("no-board.png", {"--csv", scratch_ / "lamp.csv"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("board and probes not found"));
  EXPECT_THAT(read_text(scratch_ / "lamp.csv"), HasSubstr("0,0,board and probes not found,,,,,"));
}

}  // namespace
}  // namespace cgsr::app::testing
