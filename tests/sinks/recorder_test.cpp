#include "src/sinks/recorder.h"

#include <cstring>
#include <deque>
#include <filesystem>
#include <random>
#include <string>
#include <thread>

#include <gmock/gmock.h>

#include "src/sinks/message_queue.h"
#include "tests/sinks/mcap_check.h"
#include "tests/sinks/test_recording.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::sinks {
namespace {

using test::check_mcap;
using test::read_bytes;
using testing::IsEmpty;

bool put(MessageQueue& queue, const std::string& message) {
  std::uint8_t* const place = queue.reserve(message.size());
  if (place == nullptr) return false;
  std::memcpy(place, message.data(), message.size());
  queue.commit();
  return true;
}

std::string take(MessageQueue& queue) {
  const auto message = queue.front();
  std::string text(reinterpret_cast<const char*>(message.data()), message.size());
  queue.pop();
  return text;
}

// Against a std::deque, over thousands of random steps.
TEST(MessageQueue, HandsOverWhatItTookInOrder) {
  std::mt19937 random(20261123);
  MessageQueue queue(1000);
  std::deque<std::string> shadow;
  std::size_t bytes = 0;
  int refused = 0;
  for (int step = 0; step < 20000; ++step) {
    if (random() % 2 == 0) {
      const std::string message(random() % 300, static_cast<char>('a' + step % 26));
      if (put(queue, message)) {
        shadow.push_back(message);
        bytes += message.size();
      } else {
        ++refused;
        EXPECT_GT(bytes + 2 * message.size() + 16 * (shadow.size() + 1), 700u) << "there was room";
      }
    } else if (!shadow.empty()) {
      ASSERT_EQ(take(queue), shadow.front());
      bytes -= shadow.front().size();
      shadow.pop_front();
    } else {
      ASSERT_EQ(queue.front().data(), nullptr);
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(MessageQueue, AnEmptyMessageIsAMessage) {
  MessageQueue queue(64);
  ASSERT_TRUE(put(queue, ""));
  ASSERT_NE(queue.front().data(), nullptr);
  EXPECT_EQ(take(queue), "");
  EXPECT_EQ(queue.front().data(), nullptr);
}

TEST(MessageQueue, AMessageOfHalfTheQueueAlwaysFitsWhenItIsEmpty) {
  MessageQueue queue(1024);
  for (std::size_t i = 0; i < 500; ++i) {
    ASSERT_TRUE(put(queue, std::string(i, 'x')));
    EXPECT_EQ(take(queue).size(), i);
  }
  EXPECT_FALSE(put(queue, std::string(1024, 'x')));
}

class RecorderTest : public testing::Test {
 protected:
  void SetUp() override { path_ = test::test_file(".mcap"); }
  void TearDown() override { std::filesystem::remove(path_); }

  std::unique_ptr<Recorder> create(const RecorderOptions& options = {}) {
    auto recorder = Recorder::create(path_, test::test_channels(), options);
    EXPECT_TRUE(recorder) << recorder.error().message;
    return std::move(*recorder);
  }

  std::filesystem::path path_;
};

TEST_F(RecorderTest, WritesEveryTopic) {
  const auto recorder = create();
  test::post_images(*recorder, 20);
  ASSERT_TRUE(recorder->close());
  EXPECT_TRUE(recorder->close()) << "closing twice is no error";

  const auto contents = check_mcap(read_bytes(path_));

  EXPECT_THAT(contents.problems, IsEmpty());
  EXPECT_EQ(contents.messages.size(), 45u);
  EXPECT_EQ(contents.metadata.at("recorder").at("/camera/jpeg"), "posted 5, lost 0");
  const auto statistics = recorder->statistics();
  EXPECT_EQ(statistics[test::kImage].written, 20u);
  EXPECT_GT(statistics[test::kImage].bytes, 20u * 32 * 24 * 2);
}

TEST_F(RecorderTest, WhatFindsNoRoomIsCountedByTopicAndLeavesAGapInTheSequence) {
  RecorderOptions options;
  options.queue_bytes = 5000;  // two images
  const auto recorder = create(options);
  const test::TestImage image(1);
  int taken = 0;
  for (int i = 0; i < 10; ++i) taken += recorder->post(test::kImage, test::test_stamp(i), image.view()) ? 1 : 0;
  ASSERT_TRUE(recorder->step());
  ASSERT_TRUE(recorder->post(test::kImage, test::test_stamp(10), image.view()));
  ASSERT_TRUE(recorder->close());

  const auto contents = check_mcap(read_bytes(path_));

  EXPECT_GE(taken, 1);
  EXPECT_LT(taken, 4);
  EXPECT_EQ(recorder->statistics()[test::kImage].posted, 11u);
  EXPECT_EQ(recorder->statistics()[test::kImage].lost, static_cast<std::uint64_t>(10 - taken));
  EXPECT_EQ(recorder->statistics()[test::kTrack].lost, 0u);
  EXPECT_EQ(contents.metadata.at("recorder").at("/camera/image"), fmt::format("posted 11, lost {}", 10 - taken));
  EXPECT_EQ(contents.messages.back().sequence, 10u);
}

TEST_F(RecorderTest, PostingAllocatesNothing) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "malloc is not counted under a sanitizer";
  const auto recorder = create();
  const test::TestImage image(1);
  const test::AllocationGuard guard;
  recorder->post(test::kTrack, test::test_stamp(0), "{}");
  recorder->post(test::kImage, test::test_stamp(0), image.view());
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST_F(RecorderTest, AnEmptyImageIsLostAndSaid) {
  const auto recorder = create();
  EXPECT_TRUE(recorder->post(test::kJpeg, test::test_stamp(0), ImageView{}));
  EXPECT_FALSE(recorder->step());
  EXPECT_EQ(recorder->statistics()[test::kJpeg].lost, 1u);
  EXPECT_TRUE(recorder->close());
}

// One thread posts as fast as it can, another writes: every message is written or counted as lost.
TEST_F(RecorderTest, NothingIsLostUncountedBetweenThreads) {
  RecorderOptions options;
  options.queue_bytes = 20000;
  const auto recorder = create(options);
  constexpr int kImages = 2000;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    while (!done) static_cast<void>(recorder->step());
  });
  const test::TestImage image(3);
  for (int i = 0; i < kImages; ++i) {
    recorder->post(test::kTrack, test::test_stamp(i), fmt::format("{{\"image\":{}}}", i));
    recorder->post(test::kImage, test::test_stamp(i), image.view());
  }
  done = true;
  writer.join();
  ASSERT_TRUE(recorder->close());

  const auto contents = check_mcap(read_bytes(path_));

  EXPECT_THAT(contents.problems, IsEmpty());
  std::uint64_t written = 0;
  for (const auto& topic : recorder->statistics()) {
    EXPECT_EQ(topic.written + topic.lost, topic.posted) << topic.topic;
    written += topic.written;
  }
  EXPECT_EQ(contents.messages.size(), written);
  for (const auto& message : contents.messages) {
    if (message.topic == "/track") {
      ASSERT_EQ(message.data, fmt::format("{{\"image\":{}}}", message.sequence));
    }
  }
}

}  // namespace
}  // namespace cgsr::sinks
