// The trace and the recording of a real run, read back.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"
#include "tests/sinks/mcap_check.h"
#include "tests/sinks/trace_check.h"

namespace cgsr::app::testing {
namespace {

class RunOutputs : public ::testing::Test {
 protected:
  RunOutputs() {
    const auto region = make_images(scratch_ / "images", 30);
    EXPECT_EQ(
        run_cgsr({"learn", "--input", scratch_ / "images", "--region", region, "--output", scratch_ / "m"}).exit_code,
        0);
    const auto outcome =
        run_cgsr({"run", "--config", CGSR_SOURCE_DIR "/config/robots/video.toml", "--input", scratch_ / "images",
                  "--model", scratch_ / "m", "--log-level", "warning", "--trace", scratch_ / "trace.json",
                  "--recording", scratch_ / "run.mcap", "--json", scratch_ / "run.json"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  }

  ScratchFolder scratch_;
};

TEST_F(RunOutputs, TheTraceNestsAndHoldsEveryStageAndControlCycle) {
  const auto trace = test::check_trace_file(scratch_ / "trace.json");
  EXPECT_TRUE(trace.problems.empty()) << trace.problems.front();
  EXPECT_EQ(trace.slices.at("frame"), 30);
  for (const char* const stage : {"decode", "localize", "probes", "shade", "search", "track", "decide"}) {
    EXPECT_EQ(trace.slices.at(stage), 30) << stage;
  }
  const auto run = nlohmann::json::parse(read_text(scratch_ / "run.json"));
  EXPECT_EQ(trace.arrows.at("image"), 30) << "from capture to vision";
  EXPECT_EQ(trace.arrows.at("report"), 30) << "from vision to housekeeping";
  EXPECT_GE(trace.arrows.at("goal"), 28) << "from vision to motion, which may end before the last ones";
  EXPECT_EQ(trace.slices.at("control cycle"), run.at("motion").at("control_cycles").get<int>());
}

TEST_F(RunOutputs, TheSummaryHoldsTheLastOfEveryOutput) {
  const auto run = nlohmann::json::parse(read_text(scratch_ / "run.json"));
  for (const char* const output : {"objects", "decision", "pose", "lamp", "shade"}) {
    EXPECT_EQ(run.at("outputs").at(output).at("updates"), 30) << output;
  }
  EXPECT_TRUE(run.at("outputs").at("decision").at("last").contains("goal_mps"));
}

TEST_F(RunOutputs, TheRecordingCountsWhatItHolds) {
  const auto run = nlohmann::json::parse(read_text(scratch_ / "run.json"));
  const auto& recording = run.at("recording");
  for (const char* const topic : {"/cgsr/objects", "/cgsr/decision", "/cgsr/pose", "/camera/image/compressed"}) {
    EXPECT_EQ(recording.at(topic).at("written"), 30) << topic;
    EXPECT_EQ(recording.at(topic).at("lost"), 0) << topic;
  }
  const auto contents = test::check_mcap(test::read_bytes(scratch_ / "run.mcap"));
  EXPECT_TRUE(contents.problems.empty()) << contents.problems.front();
  EXPECT_TRUE(contents.whole);
  EXPECT_EQ(contents.schemas.at("/cgsr/objects"), "cgsr/objects");
}

// `cgsr run --json F | head -2`: what is for machines is written before what nobody reads any more. Standard output is a pipe whose
// reader is gone, and unbuffered, as a summary that is longer than the buffer is in effect.
TEST_F(RunOutputs, TheSummaryForMachinesDoesNotDependOnAReaderOfTheTerminal) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "SKIPPED: a sanitizer wants to be loaded first, and so does stdbuf";
#endif
  std::filesystem::remove(scratch_ / "run.json");
  write_text(scratch_ / "piped.sh", "stdbuf -o0 \"$@\" | true\n");
  const auto outcome =
      run_cgsr({scratch_ / "piped.sh", built_cgsr(), "run", "--config", CGSR_SOURCE_DIR "/config/robots/video.toml",
                "--input", scratch_ / "images", "--model", scratch_ / "m", "--json", scratch_ / "run.json"},
               "/bin/sh");
  EXPECT_EQ(outcome.output, "");
  const auto text = read_text(scratch_ / "run.json");
  ASSERT_TRUE(nlohmann::json::accept(text)) << "no summary: " << text << outcome.errors;
  EXPECT_EQ(nlohmann::json::parse(text).at("images"), 30);
}

}  // namespace
}  // namespace cgsr::app::testing
