#pragma once

#include <array>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/can_bus.h"
#include "tests/hal/case_name.h"

namespace cgsr::hal {

/// One bus to be held to the contract of hal/can_bus.h, with another node on it.
struct CanBusRig {
  std::shared_ptr<void> world;  ///< whatever must outlive the bus.
  std::unique_ptr<CanBus> bus;
  std::function<MonoTime()> now;
  std::function<void(double)> wait;                 ///< lets seconds pass.
  std::function<void(const CanFrame&)> say;         ///< the other node sends now.
  std::function<std::vector<CanFrame>()> received;  ///< what the other node received since the last call.
};

struct CanBusCase {
  std::string name;
  std::function<CanBusRig()> make;
  friend void PrintTo(const CanBusCase& one, std::ostream* out) { *out << one.name; }
};

/// The suite. A test program that includes this header adds an implementation with one line:
///   INSTANTIATE_TEST_SUITE_P(Socket, CanBusContract, testing::Values(CanBusCase{"vcan", make_vcan}), CaseName());
class CanBusContract : public testing::TestWithParam<CanBusCase> {
 protected:
  void SetUp() override {
    rig_ = GetParam().make();
    if (!rig_.bus) GTEST_SKIP() << "SKIPPED: this machine has no such bus";
  }

  CanBus& bus() { return *rig_.bus; }

  static CanFrame numbered(std::uint8_t number) {
    CanFrame frame{.id = 0x401, .size = 8};
    frame.data = {number, 1, 2, 3, 4, 5, 6, 7};
    return frame;
  }

  std::vector<CanFrame> receive_all() {
    std::vector<CanFrame> all;
    std::array<CanFrame, 3> few;
    for (std::size_t count = few.size(); count == few.size();) {
      count = bus().receive(rig_.now(), few);
      all.insert(all.end(), few.begin(), few.begin() + static_cast<std::ptrdiff_t>(count));
    }
    return all;
  }

  CanFrame command(std::uint8_t number) {
    CanFrame frame = numbered(number);
    frame.id = 0x413;
    frame.stamp = rig_.now();
    return frame;
  }

  CanBusRig rig_;
};

TEST_P(CanBusContract, BeforeStartItIsGone) {
  EXPECT_EQ(bus().state(), CanState::kGone);
  const auto sent = bus().send(command(1));
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error(), CanSendFailure::kGone);
  std::array<CanFrame, 2> none;
  EXPECT_EQ(bus().receive(rig_.now(), none), 0U);
}

TEST_P(CanBusContract, StartingTwiceIsAnErrorAndTheBusGoesOn) {
  ASSERT_TRUE(bus().start());
  const auto again = bus().start();
  ASSERT_FALSE(again);
  EXPECT_FALSE(again.error().message.empty());
  EXPECT_TRUE(bus().send(command(1)));
  EXPECT_EQ(bus().state(), CanState::kActive);
}

TEST_P(CanBusContract, WhatIsSentIsHeardAndDoesNotComeBack) {
  ASSERT_TRUE(bus().start());
  for (std::uint8_t i = 0; i < 5; ++i) {
    ASSERT_TRUE(bus().send(command(i)));
    rig_.wait(0.01);
  }
  const auto received = rig_.received();
  ASSERT_EQ(received.size(), 5U);
  for (std::uint8_t i = 0; i < 5; ++i) {
    EXPECT_EQ(received[i].id, 0x413);
    EXPECT_EQ(received[i].size, 8);
    EXPECT_EQ(received[i].data, command(i).data);
  }
  EXPECT_TRUE(receive_all().empty());
  EXPECT_EQ(bus().counters().sent, 5U);
}

TEST_P(CanBusContract, FramesComeOldestFirstWithStampsThatNeverFall) {
  ASSERT_TRUE(bus().start());
  const MonoTime began = rig_.now();
  for (std::uint8_t i = 0; i < 10; ++i) {
    rig_.say(numbered(i));
    rig_.wait(0.001);
  }
  rig_.wait(0.01);
  const auto frames = receive_all();
  ASSERT_EQ(frames.size(), 10U);
  MonoTime last = began;
  for (std::uint8_t i = 0; i < 10; ++i) {
    EXPECT_EQ(frames[i].data, numbered(i).data);
    EXPECT_GE(frames[i].stamp, last);
    EXPECT_LE(frames[i].stamp, rig_.now());
    last = frames[i].stamp;
  }
  EXPECT_EQ(bus().counters().received, 10U);
}

TEST_P(CanBusContract, WhatCameLaterThanAskedForComesWithTheNextCall) {
  ASSERT_TRUE(bus().start());
  rig_.say(numbered(1));
  rig_.wait(0.01);
  const MonoTime between = rig_.now();
  rig_.wait(0.01);
  rig_.say(numbered(2));
  rig_.wait(0.01);
  std::array<CanFrame, 4> frames;
  ASSERT_EQ(bus().receive(between, frames), 1U);
  EXPECT_EQ(frames[0].data, numbered(1).data);
  ASSERT_EQ(bus().receive(rig_.now(), frames), 1U);
  EXPECT_EQ(frames[0].data, numbered(2).data);
}

TEST_P(CanBusContract, ShortFramesHaveZerosBehindThem) {
  ASSERT_TRUE(bus().start());
  CanFrame two{.id = 0x407, .size = 2};
  two.data = {0xAA, 0x55};
  rig_.say(two);
  rig_.wait(0.01);
  const auto frames = receive_all();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].size, 2);
  EXPECT_EQ(frames[0].data, two.data);
}

TEST_P(CanBusContract, StopIsIdempotentAndStartBeginsAnew) {
  ASSERT_TRUE(bus().start());
  ASSERT_TRUE(bus().send(command(1)));
  bus().stop();
  bus().stop();
  EXPECT_EQ(bus().state(), CanState::kGone);
  EXPECT_FALSE(bus().send(command(2)));
  rig_.wait(0.02);
  ASSERT_TRUE(bus().start());
  EXPECT_EQ(bus().counters().sent, 0U);
  EXPECT_TRUE(bus().send(command(3)));
}

}  // namespace cgsr::hal
