// What each shipped robot decides in its scenario, against what it decided when the reference was stored: box, pose, lamp, shade state, goal and
// switch requests, bit for bit. A restructuring keeps the reference; whoever changes a decision on purpose stores a new one:
//
//     for each scenario of decisions.json: build/release/cgsr run --config ROBOT --duration SECONDS --json FILE
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"
#include "tests/support/scratch_cache.h"

namespace cgsr::app::testing {
namespace {

class Decisions : public ::testing::TestWithParam<std::string> {};

TEST_P(Decisions, AreThoseOfTheStoredReference) {
  std::ifstream file(CGSR_SOURCE_DIR "/tests/app/decisions.json");
  const auto reference = nlohmann::json::parse(file).at(GetParam());
  const ScratchFolder scratch;
  const std::string summary = scratch / "run.json";
  const test::ScratchCache cache;  // the shipped robots keep rendered images
  const auto outcome =
      run_cgsr({"run", "--config", CGSR_SOURCE_DIR "/config/robots/" + GetParam() + ".toml", "--duration",
                reference.at("duration_s").dump(), "--log-level", "warning", "--json", summary});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const auto run = nlohmann::json::parse(read_text(summary));
  EXPECT_EQ(run.at("inputs_sha256"), reference.at("inputs_sha256"))
      << "other images: the simulator or the motion changed";
  EXPECT_EQ(run.at("decisions_sha256"), reference.at("decisions_sha256"));
}

INSTANTIATE_TEST_SUITE_P(Shipped, Decisions, ::testing::Values("sim-home", "sim-home-round", "sim-home-lamp"),
                         [](const auto& shipped) {
                           std::string name = shipped.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace cgsr::app::testing
