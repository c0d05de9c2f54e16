// cgsr calibrate probes as its user calls it: pictures of the probes from around a lamp whose place is known, and a robot measured with errors.
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "src/input/robot_calibration.h"
#include "tests/app/program.h"

namespace cgsr::app::testing {
namespace {

using ::testing::HasSubstr;

constexpr int kPictures = 6;

class CalibrateProbesCommand : public ::testing::Test {
 protected:
  CalibrateProbesCommand() {
    const auto exported =
        run_cgsr({"sim", "export", "--world", "home", "--robot", "lamp robot", "--output", scratch_ / "home"});
    EXPECT_EQ(exported.exit_code, 0) << exported.errors;
    std::filesystem::create_directories(scratch_ / "images");
    std::string poses = "tx,ty,tz,qw,qx,qy,qz\n";
    for (int i = 0; i < kPictures; ++i) photograph(i, poses);
    write_text(scratch_ / "poses.csv", poses);
  }

  /// One picture from 1.2 m beside the lamp, the robot turned so that its light comes from another side each time.
  void photograph(int i, std::string& poses) {
    const double around = 2.0 * std::numbers::pi * i / kPictures;
    const double heading = std::remainder(2.7 * around + 1.0, 2.0 * std::numbers::pi);
    const double x = 6.0 + 1.2 * std::cos(around);
    const double y = 3.2 + 1.2 * std::sin(around);
    std::string world = read_text(CGSR_SOURCE_DIR "/config/worlds/home.toml");
    const std::string start = "start_m = [4.6, 3.2, 0.0]";
    world.replace(world.find(start), start.size(),
                  fmt::format("start_m = [{:.6f}, {:.6f}, 0.0]\nstart_heading_deg = {:.6f}", x, y,
                              heading * 180.0 / std::numbers::pi));
    write_text(scratch_ / "world.toml", world);
    const auto drawn = run_cgsr({"sim", "render", "--world", scratch_ / "world.toml", "--robot", "lamp robot",
                                 "--output", scratch_ / fmt::format("images/{}.png", i)});
    EXPECT_EQ(drawn.exit_code, 0) << drawn.errors;
    poses += fmt::format("{:.6f},{:.6f},0,{:.8f},0,0,{:.8f}\n", x, y, std::cos(heading / 2), std::sin(heading / 2));
  }

  Outcome calibrate(const std::string& lamp) {
    return run_cgsr({"calibrate", "probes", "--input", scratch_ / "images", "--camera",
                     scratch_ / "home/calibrated/camera.yaml", "--config",
                     CGSR_SOURCE_DIR "/config/illumination/lamp-robot.toml", "--mount", measured_, "--poses",
                     scratch_ / "poses.csv", "--lamp", lamp, "--output", found_, "--json"});
  }

  /// How far a file's tips are from those of the world's robot, above the board as it has it: the board's own height is nobody's but the ruler's.
  static double off_m(const std::string& file) {
    const auto board = read_board(file);
    EXPECT_TRUE(board && *board) << file;
    double sum = 0.0;
    for (int i = 0; i < 2; ++i) {
      const auto& tip = (*board)->probe[static_cast<std::size_t>(i)].apex_m;
      sum += std::hypot(tip[0] - 0.45, tip[1] - (i == 0 ? 0.2 : -0.2), tip[2] - (*board)->position_m[2] - 0.1);
    }
    return sum / 2.0;
  }

  double lamp_off_m(const std::string& robot) {
    const auto light = run_cgsr({"light", "--config", CGSR_SOURCE_DIR "/config/illumination/lamp-robot.toml",
                                 "--camera", scratch_ / "home/calibrated/camera.yaml", "--mount", robot, "--input",
                                 scratch_ / "images", "--pose", scratch_ / "poses.csv", "--csv", scratch_ / "l.csv"});
    EXPECT_EQ(light.exit_code, 0) << light.errors;
    const std::string rows = read_text(scratch_ / "l.csv");
    double sum = 0.0;
    int count = 0;
    for (std::size_t at = 0; (at = rows.find(",1,,", at)) != std::string::npos; at += 4) {
      double x = 0.0;
      double y = 0.0;
      EXPECT_EQ(std::sscanf(rows.c_str() + at + 4, "%lf,%lf", &x, &y), 2);
      sum += std::hypot(x - 6.0, y - 3.2);
      ++count;
    }
    EXPECT_GE(count, kPictures - 1);
    return sum / count;
  }

  ScratchFolder scratch_;
  std::string measured_ = scratch_ / "home/calibrated/robot.toml";
  std::string found_ = scratch_ / "probes.toml";
};

TEST_F(CalibrateProbesCommand, FindsTheTipsByALampAtAKnownPlace) {
  const auto run = calibrate("6.0,3.2,2.75");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto json = nlohmann::json::parse(run.output);
  EXPECT_GE(json["shadows"], 8);
  EXPECT_LT(json["rms_m"].get<double>(), 0.5 * json["rms_before_m"].get<double>());
  EXPECT_LT(off_m(found_), 0.5 * off_m(measured_));
  EXPECT_LT(off_m(found_), 0.001);
  EXPECT_LT(lamp_off_m(found_), 0.6 * lamp_off_m(measured_));

  const auto elsewhere = calibrate("7.0,3.2,2.75");
  EXPECT_EQ(elsewhere.exit_code, 1);
  EXPECT_THAT(elsewhere.errors, HasSubstr("another lamp, or poses of other images"));
}

}  // namespace
}  // namespace cgsr::app::testing
