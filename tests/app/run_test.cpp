// The robot's service, from outside: repeatable in lock-step, ordered in its end.
#include <sys/ptrace.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace cgsr::app::testing {
namespace {

using ::testing::HasSubstr;

class RunReplay : public ::testing::Test {
 protected:
  RunReplay() {
    const auto region = make_images(scratch_ / "images", 60);
    EXPECT_EQ(
        run_cgsr({"learn", "--input", scratch_ / "images", "--region", region, "--output", scratch_ / "m"}).exit_code,
        0);
  }

  std::vector<std::string> arguments(const std::string& config, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{
        "run",    "--config",           config, "--input", scratch_ / "images", "--model", scratch_ / "m",
        "--json", scratch_ / "run.json"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  nlohmann::json summary() { return nlohmann::json::parse(read_text(scratch_ / "run.json")); }

  /// The shipped file, but live: images at their own rate, a thread per task.
  std::string live_config() {
    write_text(scratch_ / "live.toml", extended(shipped_, {{"run.pace", quoted("live")},
                                                           {"camera.replay.pace", quoted("own_rate")},
                                                           {"camera.replay.loop", "true"}}));
    return scratch_ / "live.toml";
  }

  ScratchFolder scratch_;
  std::string shipped_ = CGSR_SOURCE_DIR "/config/robots/video.toml";
};

TEST_F(RunReplay, LockStepGivesTheSameBytesEveryTime) {
  ASSERT_EQ(run_cgsr(arguments(shipped_)).exit_code, 0);
  const auto first = summary();
  ASSERT_EQ(run_cgsr(arguments(shipped_)).exit_code, 0);
  const auto second = summary();
  EXPECT_EQ(first["images"], 60);
  EXPECT_EQ(first["inputs_images"], 60);
  EXPECT_EQ(first["outputs_sha256"], second["outputs_sha256"]);
  EXPECT_EQ(first["inputs_sha256"], second["inputs_sha256"]);
  EXPECT_GT(first["motion"]["cycles_in_motion"], 0);
  EXPECT_EQ(first["motion"]["last_command"], nlohmann::json::array({0.0, 0.0}));
}

TEST_F(RunReplay, ADryRunComputesEverythingAndCommandsNothing) {
  ASSERT_EQ(run_cgsr(arguments(shipped_, {"--dry-run"})).exit_code, 0);
  EXPECT_EQ(summary()["motion"]["cycles_in_motion"], 0);
  EXPECT_EQ(summary()["motion"]["odometry"], nlohmann::json::array({0.0, 0.0, 0.0}));
  EXPECT_GT(summary()["found"], 50);
}

TEST_F(RunReplay, WithoutArmingItStandsStill) {
  write_text(scratch_ / "disarmed.toml", extended(shipped_, {{"motion.armed_at_start", "false"}}));
  ASSERT_EQ(run_cgsr(arguments(scratch_ / "disarmed.toml")).exit_code, 0);
  EXPECT_EQ(summary()["motion"]["cycles_in_motion"], 0);
  ASSERT_EQ(run_cgsr(arguments(scratch_ / "disarmed.toml", {"--arm"})).exit_code, 0);
  EXPECT_GT(summary()["motion"]["cycles_in_motion"], 0);
}

TEST_F(RunReplay, LiveRunsEndAfterTheirDurationWithZeroAsTheLastCommand) {
  const auto outcome = run_cgsr(arguments(live_config(), {"--duration", "2.5"}));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const auto run = summary();
  EXPECT_EQ(run["ended_by"], "the duration");
  EXPECT_GT(run["images"], 60);
  EXPECT_EQ(run["motion"]["last_command"], nlohmann::json::array({0.0, 0.0}));
  for (const auto& [name, stage] : run["stages"].items()) EXPECT_GT(stage["worst_us"], 0.0) << name;
}

/// Runs until some images are in `csv`, then ends it. \return its resident memory [MB]; also expects that no OpenGL was loaded.
double resident_mb(const std::vector<std::string>& arguments, const std::string& csv) {
  RunningCgsr running(arguments);
  while (read_text(csv).size() < 2000 && !running.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const std::string proc = "/proc/" + std::to_string(running.process());
  const auto status = read_text(proc + "/status");
  const auto maps = read_text(proc + "/maps");
  running.send(SIGTERM);
  const auto outcome = running.wait();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(maps.find("OSMesa"), std::string::npos);
  EXPECT_EQ(maps.find("cgsr-opengl"), std::string::npos);
  const auto at = status.find("VmRSS:");
  return at == std::string::npos ? 0.0 : std::stod(status.substr(at + 6)) * 1024e-6;
}

// A follower by colour, with memory locked or not: its own and what it uses of the libraries, not all that stands behind them.
TEST_F(RunReplay, ALiveFollowerTakesAtMost120MegabytesAndNoOpenGl) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "SKIPPED: a sanitizer brings its own memory";
#endif
  const auto csv = scratch_ / "run.csv";
  const double resident = resident_mb(arguments(live_config(), {"--csv", csv}), csv);
  EXPECT_GT(resident, 10.0);
  EXPECT_LE(resident, 120.0);
}

// The robot with the probe board, its map and its ball: images come from a folder, so that no simulator is in the process.
TEST_F(RunReplay, ChaptersThreeToFiveLiveTakeAtMost160MegabytesAndNoOpenGl) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "SKIPPED: a sanitizer brings its own memory";
#endif
  make_images(scratch_ / "large", 20, 2);
  write_text(scratch_ / "lamp.toml", extended(CGSR_SOURCE_DIR "/config/robots/sim-home-lamp.toml",
                                              {{"camera.kind", quoted("replay")},
                                               {"camera.replay.path", quoted(scratch_ / "large")},
                                               {"camera.replay.pace", quoted("own_rate")},
                                               {"camera.replay.loop", "true"},
                                               {"base.kind", quoted("kinematic")},
                                               {"switches.kind", quoted("dummy")},
                                               {"run.pace", quoted("live")}}));
  const auto csv = scratch_ / "run.csv";
  const double resident = resident_mb({"run", "--config", scratch_ / "lamp.toml", "--csv", csv}, csv);
  EXPECT_GT(resident, 10.0);
  EXPECT_LE(resident, 160.0);
}

TEST_F(RunReplay, ALostCameraIsAFailure) {
  write_text(scratch_ / "lock_step.toml", extended(shipped_, {{"camera.replay.loop", "true"}}));
  for (const auto& config : {live_config(), scratch_ / "lock_step.toml"}) {
    make_images(scratch_ / "images", 60);
    const auto csv = scratch_ / "run.csv";
    write_text(csv, "");
    RunningCgsr running(arguments(config, {"--csv", csv}));
    while (read_text(csv).size() < 1000 && !running.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::filesystem::remove_all(scratch_ / "images");
    const auto outcome = running.wait();
    EXPECT_EQ(outcome.exit_code, 1) << config;
    EXPECT_THAT(outcome.errors, HasSubstr("error: camera: ")) << config;
  }
}

/// A robot whose images show nothing of its map: it never knows its pose.
class LostRun : public RunReplay {
 protected:
  static constexpr auto kLastPose = "tx,ty,tz,qw,qx,qy,qz\n1.2,3.2,0,1,0,0,0\n";

  /// \return the file of a robot that stores its pose.
  std::string stores(const Keys& changes = {}) {
    const std::string maps = CGSR_SOURCE_DIR "/config/maps/home/";
    Keys keys = changes;
    keys.insert({{"localization.start.file", quoted(pose_)},
                 {"localization.start.sigma_m", "10"},
                 {"localization.map", quoted(maps + "map.obj")},
                 {"localization.camera", quoted(maps + "camera.yaml")},
                 {"localization.mount", quoted(maps + "lamp-robot.toml")}});
    write_text(scratch_ / "stores.toml", extended(live_config(), keys));
    return scratch_ / "stores.toml";
  }

  /// Ends a run by a signal, after some images. \return what it left to the next one; empty: no file.
  std::string left_by(const std::vector<std::string>& words, int signal) {
    const auto csv = scratch_ / "run.csv";
    std::filesystem::remove(csv);
    write_text(pose_, kLastPose);
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--csv", csv, "--force"});
    RunningCgsr running(all);
    while (read_text(csv).size() < 20000 && !running.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    running.send(signal);
    const auto outcome = running.wait();
    EXPECT_EQ(outcome.exit_code, signal == SIGKILL ? 128 + SIGKILL : 0) << outcome.errors;
    return std::filesystem::exists(pose_) ? read_text(pose_) : "";
  }

  const std::string pose_ = scratch_ / "last.csv";
};

// What the last run left is outdated once the robot has moved: only a run that ends knowing its pose leaves one.
TEST_F(LostRun, KilledOrEndedInOrderItLeavesNoPoseToTheNext) {
  const std::string config = stores();
  EXPECT_EQ(left_by(arguments(config), SIGKILL), "");
  EXPECT_EQ(left_by(arguments(config), SIGTERM), "");
}

TEST_F(LostRun, ThatWasNeverArmedPutsTheLastPoseBack) {
  EXPECT_EQ(left_by(arguments(stores({{"motion.armed_at_start", "false"}})), SIGTERM), kLastPose);
}

// It commands nothing, or knows of no map: killed as well it takes nothing away.
TEST_F(LostRun, ThatIsDryOrWithoutAMapLeavesTheLastPoseWhereItIs) {
  EXPECT_EQ(left_by(arguments(stores(), {"--dry-run"}), SIGKILL), kLastPose);
  const Keys no_map{{"localization.map", quoted("")}};
  EXPECT_EQ(left_by(arguments(stores(no_map)), SIGKILL), kLastPose);
}

// It may arm as a run may.
TEST_F(LostRun, AProfileKeepsTheLastPoseAsARunDoes) {
  write_text(pose_, kLastPose);
  const auto profiled = [this](const std::string& config) {
    return run_cgsr({"profile", "--config", config, "--input", scratch_ / "images", "--model", scratch_ / "m",
                     "--duration", "2.5"});
  };
  const auto disarmed = profiled(stores({{"motion.armed_at_start", "false"}}));
  ASSERT_EQ(disarmed.exit_code, 0) << disarmed.errors;
  EXPECT_EQ(read_text(pose_), kLastPose);
  const auto armed = profiled(stores());
  ASSERT_EQ(armed.exit_code, 0) << armed.errors;
  EXPECT_FALSE(std::filesystem::exists(pose_));
}

// Nothing moves in it, and the robot needs the pose for its run.
TEST_F(RunReplay, ACheckLeavesTheLastRunsPoseWhereItIs) {
  const auto pose = scratch_ / "last.csv";
  write_text(pose, "tx,ty,tz,qw,qx,qy,qz\n1.2,3.2,0,1,0,0,0\n");
  write_text(scratch_ / "stores.toml", extended(shipped_, {{"localization.start.file", quoted(pose)},
                                                           {"camera.replay.path", quoted(scratch_ / "images")},
                                                           {"run.model", quoted(scratch_ / "m")}}));
  const auto outcome = run_cgsr({"check", "--config", scratch_ / "stores.toml"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_TRUE(std::filesystem::exists(pose));
}

/// \return the number of the program's thread of that name, once there is one.
pid_t thread_named(const std::string& name, RunningCgsr& running) {
  const std::filesystem::path threads = "/proc/" + std::to_string(running.process()) + "/task";
  while (!running.ended()) {
    for (const auto& thread : std::filesystem::directory_iterator(threads)) {
      if (read_text(thread.path() / "comm") == name + "\n") return std::stoi(thread.path().filename());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return -1;
}

// The thread that reads the arming line stands still as in a driver that does not return, and goes on later.
TEST_F(RunReplay, ASwitchWorkerThatHangsIsNamedOnceAndStopsTheWheels) {
  write_text(scratch_ / "armed.toml",
             extended(live_config(), {{"switches.kind", quoted("dummy")}, {"switches.arming_line", quoted("arming")}}));
  const auto status_file = scratch_ / "status.json";
  RunningCgsr running(arguments(scratch_ / "armed.toml", {"--log-level", "info", "--status", status_file}));
  const pid_t worker = thread_named("switches", running);
  ASSERT_GT(worker, 0) << running.wait().errors;
  const auto armed = [&] { return read_text(status_file).find("\"armed\":true") != std::string::npos; };
  while (!armed() && !running.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (ptrace(PTRACE_SEIZE, worker, nullptr, nullptr) != 0) {
    GTEST_SKIP() << "SKIPPED: no thread of another process may be stopped here";
  }
  ASSERT_EQ(ptrace(PTRACE_INTERRUPT, worker, nullptr, nullptr), 0);
  int status = 0;
  ASSERT_EQ(waitpid(worker, &status, __WALL), worker);
  std::this_thread::sleep_for(std::chrono::milliseconds(1200));
  ASSERT_EQ(ptrace(PTRACE_DETACH, worker, nullptr, nullptr), 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  running.send(SIGTERM);
  const auto outcome = running.wait();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const auto first = outcome.errors.find("thread switches silent for 0.");
  ASSERT_NE(first, std::string::npos) << outcome.errors;
  EXPECT_EQ(outcome.errors.find("thread switches silent", first + 1), std::string::npos) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("motion: a stage of the safety chain is in fault"));
  EXPECT_THAT(outcome.errors, HasSubstr("line 'arming' answers again"));
}

// Whenever SIGTERM comes, from the first moment of the boot on: the program ends within 200 ms, in order, standing still. The quickest of
// three counts: another program may hold the processor meanwhile, none can make ours quicker.
TEST_F(RunReplay, SigtermInAnyPhaseEndsWithin200Milliseconds) {
  const auto config = live_config();
  const auto ends_in_order = [&](int delay_ms) {
    std::filesystem::remove(scratch_ / "run.json");
    RunningCgsr running(arguments(config));
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
    const auto begin = std::chrono::steady_clock::now();
    running.send(SIGTERM);
    const auto outcome = running.wait();
    const auto took = std::chrono::steady_clock::now() - begin;
    if (outcome.exit_code == 128 + SIGTERM) {  // before main there is nobody to catch it, and nothing that moves
      EXPECT_EQ(outcome.errors, "") << delay_ms << " ms: killed although it had begun";
      return took;
    }
    if (outcome.exit_code == 3) {  // nothing had been started yet, so there is nothing to report
      EXPECT_THAT(outcome.errors, HasSubstr("while loading")) << delay_ms;
      return took;
    }
    EXPECT_EQ(outcome.exit_code, 0) << delay_ms << " ms: " << outcome.errors;
    if (outcome.exit_code != 0) return took;
    EXPECT_FALSE(summary().contains("inputs_sha256")) << "pixels are summed in lock-step only";
    EXPECT_EQ(summary()["ended_by"], "SIGTERM") << delay_ms;
    EXPECT_EQ(summary()["motion"]["last_command"], nlohmann::json::array({0.0, 0.0})) << delay_ms;
    return took;
  };
  for (const int delay_ms : {0, 2, 5, 10, 20, 40, 80, 160, 320, 1500, 2400}) {
    auto quickest = ends_in_order(delay_ms);
    for (int again = 0; again < 2 && quickest >= std::chrono::milliseconds(200); ++again) {
      quickest = std::min(quickest, ends_in_order(delay_ms));
    }
    EXPECT_LT(quickest, std::chrono::milliseconds(200)) << delay_ms;
  }
}

}  // namespace
}  // namespace cgsr::app::testing
