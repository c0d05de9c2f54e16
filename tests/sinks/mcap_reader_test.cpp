// The recordings as MCAP's own reader (npm's @mcap/core) finds them.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/sinks/mcap_check.h"
#include "tests/sinks/test_recording.h"

namespace cgsr::sinks {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// \return exit code and standard output.
std::pair<int, std::string> run(const std::string& command) {
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return {-1, ""};
  std::string output;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) output.append(buffer.data(), n);
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output};
}

class McapReaderTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto [code, reason] = run(CGSR_SOURCE_DIR "/tests/sinks/mcap_reader/install.sh " CGSR_READER_DIR);
    const char* const ci = std::getenv("CI");
    if (code == 77 && (ci == nullptr || std::string_view(ci) != "true")) {
      GTEST_SKIP() << "skipped: MCAP's reader cannot be installed: " << reason;
    }
    ASSERT_EQ(code, 0) << reason;
    path_ = test::test_file(".mcap");
    RecorderOptions options;
    options.file.chunk_bytes = 20000;
    auto recorder = Recorder::create(path_, test::test_channels(), options);
    ASSERT_TRUE(recorder) << recorder.error().message;
    test::post_images(**recorder, kImages);
    ASSERT_TRUE((*recorder)->close());
  }
  void TearDown() override { std::filesystem::remove(path_); }

  [[nodiscard]] json read(const std::string& cuts = "") const {
    const auto [code, output] = run("node " CGSR_READER_DIR "/read.mjs " + path_.string() + cuts);
    EXPECT_EQ(code, 0) << output;
    return json::parse(output, nullptr, false);
  }

  static constexpr int kImages = 40;
  std::filesystem::path path_;
};

TEST_F(McapReaderTest, FindsChannelsSchemasAndEveryMessage) {
  const json file = read();

  EXPECT_EQ(file["message_count"], 90);
  EXPECT_GT(file["chunks"], 3);
  EXPECT_EQ(file["metadata"]["recorder"]["/track"], "posted 40, lost 0");
  ASSERT_EQ(file["channels"].size(), 3u);
  EXPECT_EQ(file["channels"][0]["schema_encoding"], "jsonschema");
  EXPECT_EQ(file["channels"][0]["schema_text"]["properties"]["x_m"]["unit"], "m");
  EXPECT_EQ(file["channels"][1]["schema"], "sensor_msgs/msg/Image");
  EXPECT_EQ(file["channels"][1]["encoding"], "cdr");
  EXPECT_THAT(file["channels"][1]["schema_text"].get<std::string>(), HasSubstr("MSG: builtin_interfaces/Time\n"));
  int image = 0;
  for (const json& message : file["messages"]) {
    if (message["topic"] != "/track") continue;
    EXPECT_EQ(message["sequence"], image);
    EXPECT_EQ(message["stamp_ns"], test::test_stamp(image).time_since_epoch().count());
    EXPECT_EQ(message["message"], (json{{"image", image}, {"x_m", 0.5 * image}}));
    ++image;
  }
  EXPECT_EQ(image, kImages);
}

TEST_F(McapReaderTest, DecodesTheImagesFromCdr) {
  int images = 0;
  int jpegs = 0;
  const json recording = read();
  for (const json& message : recording["messages"]) {
    const auto stamp = message["stamp_ns"].get<std::int64_t>();
    const json& body = message["message"];
    if (message["topic"] == "/track") continue;
    EXPECT_EQ(body["header"]["sec"], stamp / 1'000'000'000);
    EXPECT_EQ(body["header"]["nanosec"], stamp % 1'000'000'000);
    EXPECT_EQ(body["header"]["frame_id"], "camera");
    if (message["topic"] == "/camera/jpeg") {
      EXPECT_EQ(body["format"], "jpeg");
      EXPECT_EQ(body["is_jpeg"], true);
      ++jpegs;
      continue;
    }
    EXPECT_EQ(body["width"], test::TestImage::kWidth);
    EXPECT_EQ(body["height"], test::TestImage::kHeight);
    EXPECT_EQ(body["encoding"], "yuv422_yuy2");
    EXPECT_EQ(body["is_bigendian"], 0);
    EXPECT_EQ(body["step"], 2 * test::TestImage::kWidth);
    EXPECT_EQ(body["bytes"], 2 * test::TestImage::kWidth * test::TestImage::kHeight);
    EXPECT_EQ(body["sum"], test::TestImage(images).sum());
    ++images;
  }
  EXPECT_EQ(images, kImages);
  EXPECT_EQ(jpegs, kImages / 4);
}

TEST_F(McapReaderTest, ReadsAFileCutAnywhereUpToTheCut) {
  const std::string whole = test::read_bytes(path_);
  const auto all = test::check_mcap(whole);
  EXPECT_THAT(all.problems, testing::IsEmpty());
  std::mt19937 random(20261123);
  std::vector<std::size_t> cuts;
  std::string arguments;
  for (int trial = 0; trial < 50; ++trial) {
    cuts.push_back(std::uniform_int_distribution<std::size_t>(0, whole.size() - 1)(random));
    arguments += fmt::format(" {}", cuts.back());
  }

  const json found = read(arguments);

  ASSERT_EQ(found.size(), cuts.size());
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    std::size_t expected = 0;
    for (const auto& chunk : all.chunks) expected += chunk.end <= cuts[i] ? chunk.messages : 0;
    // The index behind a chunk may be cut too: its messages count all the same.
    EXPECT_EQ(found[i], expected) << cuts[i];
  }
}

// docs/guides/read-a-recording.md: its program, as it stands there.
TEST_F(McapReaderTest, TheGuidesProgramRuns) {
  const std::string page = test::read_bytes(CGSR_SOURCE_DIR "/docs/guides/read-a-recording.md");
  const std::string fence = "```js\n";
  const std::size_t begin = page.find(fence);
  ASSERT_NE(begin, std::string::npos);
  const std::size_t first = begin + fence.size();
  const std::filesystem::path program = std::filesystem::path(CGSR_READER_DIR) / "count.mjs";
  std::ofstream(program) << page.substr(first, page.find("```", first) - first);

  const auto [code, output] = run("node " + program.string() + " " + path_.string());

  EXPECT_EQ(code, 0);
  EXPECT_EQ(output,
            "/track 40 {\"image\":39,\"x_m\":19.5}\n"
            "/camera/image 40 \"CDR\"\n"
            "/camera/jpeg 10 \"CDR\"\n");
}

}  // namespace
}  // namespace cgsr::sinks
