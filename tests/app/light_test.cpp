// cgsr light as its user calls it: on a picture of the simulated home, with the robot's calibration measured with errors.
#include <array>
#include <cmath>
#include <cstdio>
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
    const auto drawn = run_cgsr({"sim", "render", "--world", "home", "--robot", robot, "--output", scratch_ / name});
    ASSERT_EQ(drawn.exit_code, 0) << drawn.errors;
  }

  Outcome light(const std::string& image, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"light",
                                       "--config",
                                       CGSR_SOURCE_DIR "/config/illumination/lamp-robot.toml",
                                       "--camera",
                                       scratch_ / "home/calibrated/camera.yaml",
                                       "--mount",
                                       scratch_ / "home/calibrated/robot.toml",
                                       "--input",
                                       scratch_ / image};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_cgsr(arguments);
  }

  ScratchFolder scratch_;
};

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

TEST_F(LightCommand, SaysWhyThereIsNoLamp) {
  photograph("robot", "no-board.png");
  const auto outcome = light("no-board.png", {"--csv", scratch_ / "lamp.csv"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("board and probes not found"));
  EXPECT_THAT(read_text(scratch_ / "lamp.csv"), HasSubstr("0,0,board and probes not found,,,,,"));
}

}  // namespace
}  // namespace cgsr::app::testing
