// The closed loop as a user starts it: the robot's program, the simulator beside it, and what truth says about the run.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"
#include "tests/support/scratch_cache.h"

namespace cgsr::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class RunSimulated : public ::testing::Test {
 protected:
  /// The shipped robot with images of half the size.
  std::string small_robot(const Keys& changes = {}) {
    Keys keys = half_size(changes);
    keys.insert({{"run.learn.x_px", "118"},
                 {"run.learn.y_px", "125"},
                 {"run.learn.width_px", "33"},
                 {"run.learn.height_px", "64"}});
    const std::string file = scratch_ / ("robot" + std::to_string(++robots_) + ".toml");
    write_text(file, extended(CGSR_SOURCE_DIR "/config/robots/sim-home.toml", keys));
    return file;
  }

  /// The shipped scenario with other words. \return its file.
  std::string scenario(const Keys& words, const std::string& more = {}) {
    auto text = read_text(CGSR_SOURCE_DIR "/config/scenarios/home-follow.toml");
    replace(text, "\"../worlds", "\"" CGSR_SOURCE_DIR "/config/worlds");
    for (const auto& [from, to] : words) replace(text, from, to);
    const std::string file = scratch_ / ("scenario" + std::to_string(++scenarios_) + ".toml");
    write_text(file, text + "\n" + more);
    return file;
  }

  nlohmann::json run(const std::string& config, const std::string& duration_s, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"run",    "--config",           config, "--duration", duration_s,
                                   "--json", scratch_ / "run.json"};
    words.insert(words.end(), more.begin(), more.end());
    const auto outcome = run_cgsr(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return outcome.exit_code == 0 ? nlohmann::json::parse(read_text(scratch_ / "run.json")) : nlohmann::json{};
  }

  ScratchFolder scratch_;
  int robots_ = 0;
  int scenarios_ = 0;
};

const Keys kArmedEarly{{"from_s = 1.5", "from_s = 1.1"}};
const Keys kPlainEdges{{"ends_at_s = 46.0", "ends_at_s = 46.0\ncamera = { edge_samples = 1 }"}};

// Learned from the first image, armed by a switch, followed over a way that turns twice, while the lamp dims and turns bluish.
TEST_F(RunSimulated, FindsAndFollowsTheCartThroughChangingLight) {
  const auto summary =
      run(small_robot({{"sim.scenario", quoted(scenario(kPlainEdges))}}), "15", {"--video", scratch_ / "run.avi"});
  const auto truth = summary["truth"];
  EXPECT_GE(truth["in_view_share"], 0.95);
  EXPECT_GE(truth["found_right_share"], 0.95);
  EXPECT_GE(truth["nearest_by_own_motion"], 0.8);
  EXPECT_LE(truth["fastest_object_mps"], 0.5);
  EXPECT_GT(summary["motion"]["odometry"][0], 0.5) << "it did not drive: the test says nothing";
  EXPECT_EQ(summary["motion"]["last_command"], nlohmann::json::array({0.0, 0.0}));
  EXPECT_GT(std::filesystem::file_size(scratch_ / "run.avi"), 1000000u);
}

// However the images come about. Keeping them spares a later run their drawing, and changes nothing else.
TEST_F(RunSimulated, TheSameBytesOnOneThreadAndOnTwoAndOutOfTheCacheAndOthersForAnotherSeed) {
  const test::ScratchCache cache;
  const std::string folder = cache.path();
  const Keys armed{{"sim.scenario", quoted(scenario(kArmedEarly))}};
  const auto robot = [&](const std::string& key, const std::string& value) {
    Keys keys = armed;
    keys[key] = value;
    return small_robot(keys);
  };
  const auto two = run(small_robot(armed), "1.7");
  EXPECT_GT(two["motion"]["cycles_in_motion"], 20) << "it did not drive: the test says less";
  EXPECT_FALSE(std::filesystem::exists(folder)) << "kept although nobody asked for it";
  const auto one = run(robot("sim.threads", "1"), "1.7");
  const auto fresh = run(robot("sim.cache", "true"), "1.7");
  const auto images = std::distance(std::filesystem::recursive_directory_iterator(folder), {});
  const auto repeated = run(robot("sim.cache", "true"), "1.7");
  EXPECT_GT(images, 40);
  for (const char* const what : {"inputs_sha256", "outputs_sha256", "truth"}) {
    EXPECT_EQ(one[what], two[what]) << what;
    EXPECT_EQ(fresh[what], two[what]) << what;
    EXPECT_EQ(repeated[what], two[what]) << what;
  }
  EXPECT_NE(run(small_robot(armed), "1.7", {"--seed", "2"})["inputs_sha256"], two["inputs_sha256"]);
}

// The robot's program must start and drive where there is no ray tracer.
TEST_F(RunSimulated, TheProgramLinksNoRayTracer) {
  const std::string list = scratch_ / "needed";
  ASSERT_EQ(std::system(("ldd " CGSR_PROGRAM " > " + list).c_str()), 0);
  EXPECT_THAT(read_text(list), HasSubstr("libopencv_core"));
  EXPECT_THAT(read_text(list), Not(HasSubstr("embree")));
}

TEST_F(RunSimulated, APlugInThatIsMissingForeignOrOfAnotherVersionIsNamed) {
  const auto refusal = [&](const std::string& plug_in) {
    const auto outcome = run_cgsr({"run", "--config", small_robot({{"sim.plug_in", quoted(plug_in)}})});
    EXPECT_EQ(outcome.exit_code, 1);
    return outcome.errors;
  };
  EXPECT_THAT(refusal("/nowhere/sim.so"), HasSubstr("/nowhere/sim.so: cannot open shared object file"));
  EXPECT_THAT(refusal(CGSR_FOREIGN_PLUGIN), HasSubstr("is no simulator of this program"));
  EXPECT_THAT(refusal(CGSR_OLD_PLUGIN), HasSubstr("is a simulator of version 0, this program needs version"));
}

TEST_F(RunSimulated, CheckLooksAtTheHomeAndSaysWhatIsWrongWithIt) {
  const auto good = run_cgsr({"check", "--config", small_robot()});
  EXPECT_EQ(good.exit_code, 0) << good.errors;
  EXPECT_THAT(good.output, HasSubstr("320x240 at 30.00 Hz"));
  const auto bad = run_cgsr({"check", "--config", small_robot({{"sim.scenario", quoted("nowhere.toml")}})});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.errors, HasSubstr("nowhere.toml"));
}

// No faster than the clock, however fast the machine; what it computes does not depend on the pace.
TEST_F(RunSimulated, RealTimeTakesItsTimeAndGivesTheSameBytes) {
  const auto fast = run(small_robot(), "0.8");
  const auto begin = std::chrono::steady_clock::now();
  const auto paced = run(small_robot({{"run.pace", quoted("real_time")}}), "0.8");
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(720));
  EXPECT_EQ(paced["outputs_sha256"], fast["outputs_sha256"]);
}

// Trouble on the bus, at the base and at the camera reaches the robot as it would reach a real one.
TEST_F(RunSimulated, TroubleByScriptStopsTheRobotAndIsNamed) {
  Keys words = kArmedEarly;
  words.insert(kPlainEdges.begin(), kPlainEdges.end());
  const auto robot_with = [&](const std::string& trouble) {
    return small_robot({{"sim.scenario", quoted(scenario(words, trouble + "from_s = 1.9\n"))}});
  };
  for (const auto& [trouble, latched] : {std::pair("[[base_event]]\nwhat = \"emergency_stop\"\n", "refuses motion"),
                                         std::pair("[[bus_event]]\nwhat = \"bus_off\"\n", "does not take commands"),
                                         std::pair("[[bus_event]]\nwhat = \"base_silent\"\n", "odometry")}) {
    const auto motion = run(robot_with(trouble), "2.5")["motion"];
    EXPECT_GT(motion["cycles_in_motion"], 50) << trouble;
    EXPECT_THAT(motion["latched"].get<std::string>(), HasSubstr(latched)) << trouble;
  }
  const auto gone = run_cgsr({"run", "--config", robot_with("[[camera_event]]\nwhat = \"gone\"\n")});
  EXPECT_EQ(gone.exit_code, 1);
  EXPECT_THAT(gone.errors, HasSubstr("error: camera: the simulated camera is gone"));
}

TEST_F(RunSimulated, LiveThreadsAndASimulatedCameraDoNotGoTogether) {
  const auto outcome = run_cgsr({"run", "--config", small_robot({{"run.pace", quoted("live")}})});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("lock_step or real_time"));
}

}  // namespace
}  // namespace cgsr::app::testing
