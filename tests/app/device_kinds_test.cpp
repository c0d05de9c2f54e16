// Any mix of devices works: each kind is chosen by its own key.
#include <csignal>

#include <chrono>
#include <string>
#include <thread>
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

class DeviceKinds : public ::testing::Test {
 protected:
  DeviceKinds() { make_images(scratch_ / "images", 60); }

  /// A robot before made images that drives as soon as it may.
  std::string robot(const Keys& changes) {
    Keys keys = changes;
    keys.insert({{"camera.replay.path", quoted(scratch_ / "images")},
                 {"run.learn.x_px", "40"},
                 {"run.learn.y_px", "80"},
                 {"run.learn.width_px", "60"},
                 {"run.learn.height_px", "80"},
                 {"motion.armed_at_start", "false"}});
    write_text(scratch_ / "robot.toml", extended(CGSR_SOURCE_DIR "/config/robots/video.toml", keys));
    return scratch_ / "robot.toml";
  }

  /// The simulated home, its images small.
  static Keys in_the_home(const Keys& changes) {
    Keys keys = changes;
    keys.insert({{"sim.scenario", quoted(CGSR_SOURCE_DIR "/config/scenarios/home-follow.toml")},
                 {"sim.width_px", "64"},
                 {"sim.height_px", "48"}});
    return keys;
  }

  /// The simulated camera, and where in its first image the cart is.
  static Keys before_the_cart(const Keys& changes) {
    Keys keys = changes;
    keys.insert({{"camera.kind", quoted("sim")},
                 {"sim.width_px", "320"},
                 {"sim.height_px", "240"},
                 {"run.learn.x_px", "118"},
                 {"run.learn.y_px", "125"},
                 {"run.learn.width_px", "33"},
                 {"run.learn.height_px", "64"}});
    return in_the_home(keys);
  }

  nlohmann::json run(const std::string& config, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"run", "--config", config, "--arm", "--json", scratch_ / "run.json"};
    words.insert(words.end(), more.begin(), more.end());
    const auto outcome = run_cgsr(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    log_ = outcome.errors;
    return outcome.exit_code == 0 ? nlohmann::json::parse(read_text(scratch_ / "run.json")) : nlohmann::json{};
  }

  ScratchFolder scratch_;
  std::string log_;
};

// Not the ideal base: its emergency stop is pressed by the scenario, and its driver says so.
TEST_F(DeviceKinds, ReplayedImagesDriveTheSimulatedSegwayOnItsBus) {
  auto scenario = read_text(CGSR_SOURCE_DIR "/config/scenarios/home-follow.toml");
  replace(scenario, "\"../worlds", "\"" CGSR_SOURCE_DIR "/config/worlds");
  write_text(scratch_ / "scenario.toml", scenario + "\n[[base_event]]\nwhat = \"emergency_stop\"\nfrom_s = 1.2\n");
  const auto summary = run(robot({{"base.kind", quoted("rmp")}, {"sim.scenario", quoted(scratch_ / "scenario.toml")}}));
  EXPECT_THAT(log_, HasSubstr("world home"));
  EXPECT_EQ(summary["images"], 59) << "the first one is learned from";
  EXPECT_EQ(summary.count("truth"), 0U) << "what the replayed images show is not known";
  EXPECT_GT(summary["motion"]["cycles_in_motion"], 15);
  EXPECT_THAT(summary["motion"]["latched"].get<std::string>(), HasSubstr("refuses motion"));
  EXPECT_NE(summary["motion"]["odometry"], nlohmann::json::array({0.0, 0.0, 0.0}));
  EXPECT_EQ(summary["motion"]["last_command"], nlohmann::json::array({0.0, 0.0}));
}

// Threads, rings and the CAN driver meet: the images come at their own rate, the Segway moves by the real clock. The best of five runs counts:
// where another program holds the processor the images are late, and the robot rightly stands still.
TEST_F(DeviceKinds, LiveThreadsDriveTheSimulatedSegwayBeforeReplayedImages) {
  const Keys keys = in_the_home({{"base.kind", quoted("rmp")},
                                 {"switches.kind", quoted("sim")},
                                 {"run.pace", quoted("live")},
                                 {"camera.replay.pace", quoted("own_rate")}});
  auto summary = run(robot(keys), {"--duration", "1.8"});
  for (int attempt = 1; attempt < 5 && summary["motion"]["cycles_in_motion"] <= 15; ++attempt) {
    summary = run(robot(keys), {"--duration", "1.8"});
  }
  EXPECT_GT(summary["motion"]["cycles_in_motion"], 15);
  EXPECT_NE(summary["motion"]["odometry"], nlohmann::json::array({0.0, 0.0, 0.0}));
  EXPECT_EQ(summary["motion"]["last_command"], nlohmann::json::array({0.0, 0.0}));
}

// Whether there is a mount or not, the calibration is the one camera model of all that look through it.
TEST_F(DeviceKinds, TheCalibrationOfAnotherCameraIsRefusedWithoutAMountToo) {
  auto camera = read_text(CGSR_SOURCE_DIR "/config/maps/home/camera.yaml");
  replace(camera, "image_height: 480", "image_height: 360");
  write_text(scratch_ / "camera.yaml", camera);
  const auto outcome =
      run_cgsr({"check", "--config", robot({{"localization.camera", quoted(scratch_ / "camera.yaml")}})});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("another camera's file?"));
}

TEST_F(DeviceKinds, TheSimulatedCameraGoesWithAnIdealBaseAndLinesInMemory) {
  const Keys keys = before_the_cart({{"switches.arming_line", quoted("a line that the scenario does not have")}});
  const auto summary = run(robot(keys), {"--duration", "0.5"});
  EXPECT_EQ(summary["images"], 14);
  EXPECT_EQ(summary.count("truth"), 1U);
  EXPECT_THAT(log_, HasSubstr("the simulated camera stands still"));
}

// The lines are those of the scenario: one that it does not have is refused, beside those that it has.
TEST_F(DeviceKinds, ReplayedImagesGoWithTheLinesOfTheSimulatedHome) {
  const Keys named = in_the_home({{"switches.kind", quoted("sim")}, {"switches.arming_line", quoted("arming")}});
  EXPECT_EQ(run(robot(named))["images"], 59);
  Keys wrong = named;
  wrong["switches.arming_line"] = quoted("armign");
  const auto refused = run_cgsr({"check", "--config", robot(wrong)});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.errors, AllOf(HasSubstr("armign"), HasSubstr("arming")));
}

TEST_F(DeviceKinds, OnlyADeviceOfTheSimulatedHomeLoadsIt) {
  EXPECT_EQ(run(robot({{"sim.plug_in", quoted("/nowhere.so")}}))["images"], 59);
  for (const Keys& kind : {Keys{{"camera.kind", quoted("sim")}}, Keys{{"base.kind", quoted("rmp")}},
                           Keys{{"switches.kind", quoted("sim")}}}) {
    Keys keys = in_the_home(kind);
    keys["sim.plug_in"] = quoted("/nowhere.so");
    const auto outcome = run_cgsr({"check", "--config", robot(keys)});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.errors, HasSubstr("/nowhere.so")) << kind.begin()->first;
  }
}

TEST_F(DeviceKinds, TheKeysOfBeforeAreNamedWithThoseOfNow) {
  const auto outcome =
      run_cgsr({"check", "--config",
                robot({{"camera.source", quoted("sim")}, {"rmp.hold_s", "0.1"}, {"drive.max_forward_mps", "1.0"}})});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, AllOf(HasSubstr("camera.source is unknown; it is called kind now; base.kind, base.can "
                                              "and switches.kind choose the other devices"),
                                    HasSubstr("rmp is unknown; it is called base.rmp now"),
                                    HasSubstr("drive is unknown; it is called base.kinematic now")));
}

TEST_F(DeviceKinds, AnUnknownKindIsNamedWithThoseThatThereAre) {
  const auto outcome = run_cgsr({"check", "--config", robot({{"camera.kind", quoted("replya")}})});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, AllOf(HasSubstr("camera.kind = \"replya\" is not one of \"replay\", \"sim\", \"v4l2\""),
                                    HasSubstr("did you mean \"replay\"?")));
}

// A device that is not part of the home is looked at although the home cannot be built.
TEST_F(DeviceKinds, CheckFindsTheProblemsOfEachDeviceAtOnce) {
  Keys keys = in_the_home({{"base.kind", quoted("rmp")}, {"camera.replay.path", quoted(scratch_ / "none")}});
  keys["sim.scenario"] = quoted("nowhere.toml");
  keys["switches.arming_line"] = quoted("arm");
  keys["switches.fill_light_line"] = quoted("arm");
  const auto outcome = run_cgsr({"check", "--config", robot(keys)});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, AllOf(HasSubstr("nowhere.toml"), HasSubstr(scratch_ / "none"), HasSubstr("'arm'")));
}

// What a computer without a robot's devices says of a robot's file: each device by its name, with what to do about it.
class RealDevices : public DeviceKinds {
 protected:
  std::string real(Keys keys = {}) {
    keys.insert({{"run.pace", quoted("live")},
                 {"camera.kind", quoted("v4l2")},
                 {"camera.v4l2.device", quoted("no-such-camera")},
                 {"base.kind", quoted("rmp")},
                 {"base.can", quoted("socketcan")},
                 {"base.socketcan.interface", quoted("nocan7")},
                 {"switches.kind", quoted("gpiod")},
                 {"switches.arming_line", quoted("no-such-line")}});
    return robot(keys);
  }
};

TEST_F(RealDevices, CheckNamesEachThatIsMissing) {
  const auto outcome = run_cgsr({"check", "--config", real()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, AllOf(HasSubstr("camera 'no-such-camera' is not there: `cgsr devices`"),
                                    HasSubstr("CAN: "), HasSubstr("no-such-line")));
}

TEST_F(RealDevices, CheckOfAServiceTakesThemForLate) {
  const auto outcome = run_cgsr({"check", "--devices-may-be-late", "--config", real()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("not there yet: camera 'no-such-camera'"), HasSubstr("good")));
  const auto wrong = run_cgsr({"check", "--devices-may-be-late", "--config", real({{"run.model", quoted("/none")}})});
  EXPECT_EQ(wrong.exit_code, 1) << "a model is not late, it is missing";
}

TEST_F(RealDevices, WithoutWaitingTheRunEndsAtTheFirstThatIsMissing) {
  const auto outcome = run_cgsr({"run", "--config", real()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("camera 'no-such-camera' is not there"));
}

// It says once what it waits for, and a signal ends it in order.
TEST_F(RealDevices, AServiceWaitsForALateCameraAndSaysSoOnce) {
  RunningCgsr running({"run", "--wait-for-devices", "--config", real()});
  std::this_thread::sleep_for(std::chrono::seconds(3));
  EXPECT_FALSE(running.ended());
  running.send(SIGTERM);
  const auto outcome = running.wait();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("ended by SIGTERM before the robot was there: camera 'no-such-camera'"));
  const auto first = outcome.errors.find("waiting for the camera");
  ASSERT_NE(first, std::string::npos) << outcome.errors;
  EXPECT_EQ(outcome.errors.find("waiting for the camera", first + 1), std::string::npos) << outcome.errors;
}

}  // namespace
}  // namespace cgsr::app::testing
