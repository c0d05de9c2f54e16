#include "src/sinks/mcap_file.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/sinks/mcap_check.h"
#include "tests/sinks/test_recording.h"

namespace cgsr::sinks {
namespace {

using test::check_mcap;
using test::McapContents;
using test::read_bytes;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

class McapFileTest : public testing::TestWithParam<McapCompression> {
 protected:
  void SetUp() override {
    std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '_');
    path_ = std::filesystem::path(testing::TempDir()) / ("mcap_" + name + ".mcap");
  }
  void TearDown() override { std::filesystem::remove(path_); }

  [[nodiscard]] McapOptions options() const {
    McapOptions options;
    options.compression = GetParam();
    options.chunk_bytes = 3000;
    return options;
  }

  // `messages` on two topics, a chunk now and then.
  void write(int messages, bool close) {
    auto file = McapFile::create(path_, test::test_channels(), options());
    ASSERT_TRUE(file) << file.error().message;
    for (int i = 0; i < messages; ++i) {
      const std::string text = fmt::format("{{\"image\":{},\"x_m\":0.5}}", i);
      ASSERT_TRUE(file->write(i % 3 == 0 ? 1 : 0, static_cast<std::uint32_t>(i), test::test_stamp(i), bytes_of(text)));
    }
    if (!close) return;
    ASSERT_TRUE(file->close());
    EXPECT_TRUE(file->close()) << "closing twice is no error";
    EXPECT_EQ(file->statistics().messages, static_cast<std::uint64_t>(messages));
    EXPECT_EQ(file->statistics().bytes, std::filesystem::file_size(path_));
  }

  std::filesystem::path path_;
};

TEST_P(McapFileTest, WhatIsWrittenIsReadBackInOrder) {
  write(200, true);

  const McapContents contents = check_mcap(read_bytes(path_));

  EXPECT_THAT(contents.problems, IsEmpty());
  EXPECT_TRUE(contents.whole);
  EXPECT_EQ(contents.profile, "") << "with JSON in it the file is no recording of ROS 2";
  EXPECT_THAT(contents.schemas,
              ElementsAre(Pair("/camera/image", "sensor_msgs/msg/Image"),
                          Pair("/camera/jpeg", "sensor_msgs/msg/CompressedImage"), Pair("/track", "cgsr/TestOutput")));
  ASSERT_EQ(contents.messages.size(), 200u);
  EXPECT_GT(contents.chunks.size(), 3u);
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_EQ(contents.messages[i].topic, i % 3 == 0 ? "/camera/image" : "/track");
    EXPECT_EQ(contents.messages[i].sequence, i);
    EXPECT_EQ(contents.messages[i].stamp_ns,
              static_cast<std::uint64_t>(test::test_stamp(static_cast<int>(i)).time_since_epoch().count()));
    EXPECT_EQ(nlohmann::json::parse(contents.messages[i].data)["image"], i);
  }
}

TEST_P(McapFileTest, AFileCutAnywhereGivesEveryWholeChunkBeforeTheCut) {
  write(200, true);
  const std::string whole = read_bytes(path_);
  const McapContents all = check_mcap(whole);
  std::mt19937 random(20261123);
  for (int trial = 0; trial < 200; ++trial) {
    const auto cut = std::uniform_int_distribution<std::size_t>(0, whole.size() - 1)(random);
    const McapContents part = check_mcap(whole.substr(0, cut));
    std::size_t expected = 0;
    for (const auto& chunk : all.chunks) expected += chunk.end <= cut ? chunk.messages : 0;
    EXPECT_EQ(part.messages.size(), expected) << cut;
    EXPECT_THAT(part.problems, IsEmpty()) << cut;
    EXPECT_FALSE(part.whole);
  }
}

TEST_P(McapFileTest, AFlippedByteIsFound) {
  write(30, true);
  const std::string whole = read_bytes(path_);
  std::mt19937 random(7);
  for (int trial = 0; trial < 100; ++trial) {
    std::string damaged = whole;
    // Behind the magic and header, in front of the footer's checksum: data or summary.
    const auto at = std::uniform_int_distribution<std::size_t>(8, whole.size() - 13)(random);
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    const McapContents contents = check_mcap(damaged);
    EXPECT_TRUE(!contents.problems.empty() || !contents.whole) << at;
  }
}

TEST_P(McapFileTest, AnEmptyRecordingIsWhole) {
  write(0, true);
  const McapContents contents = check_mcap(read_bytes(path_));
  EXPECT_THAT(contents.problems, IsEmpty());
  EXPECT_TRUE(contents.whole);
}

INSTANTIATE_TEST_SUITE_P(Compression, McapFileTest, testing::Values(McapCompression::kNone, McapCompression::kLz4),
                         [](const auto& each) { return each.param == McapCompression::kLz4 ? "Lz4" : "None"; });

TEST(McapFile, AllCdrMakesARecordingOfRos2) {
  const auto path = test::test_file(".mcap");
  {
    auto file = McapFile::create(path, {image_channel("/camera/image")});
    ASSERT_TRUE(file) << file.error().message;
  }  // closes
  const McapContents contents = check_mcap(read_bytes(path));
  EXPECT_EQ(contents.profile, "ros2");
  EXPECT_TRUE(contents.whole);
  std::filesystem::remove(path);
}

TEST(McapFile, ChunksAreBoundedInTimeToo) {
  const auto path = test::test_file(".mcap");
  auto file = McapFile::create(path, test::test_channels());
  ASSERT_TRUE(file) << file.error().message;
  for (int i = 0; i <= 16; ++i) ASSERT_TRUE(file->write(0, 0, test::test_stamp(i), bytes_of("{}")));
  EXPECT_EQ(check_mcap(read_bytes(path)).messages.size(), 17u) << "0.53 s: on disk before anything is closed";
  std::filesystem::remove(path);
}

TEST(McapFile, AFileThatCannotBeWrittenIsNamed) {
  const auto missing = McapFile::create("/nowhere/at/all.mcap", {});
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("/nowhere/at/all.mcap"));

  const auto full = McapFile::create("/dev/full", test::test_channels());
  ASSERT_FALSE(full);
  EXPECT_THAT(full.error().message, HasSubstr("/dev/full"));
}

}  // namespace
}  // namespace cgsr::sinks
