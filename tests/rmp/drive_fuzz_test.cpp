// The base's driver on a bus on which anything may travel: damaged, random and foreign frames among those of a healthy base. A shadow model
// knows only what arrived and what was called; it says when nothing but zero may leave.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "hal/rmp/rmp_drive.h"
#include "tests/rmp/frames.h"
#include "tests/rmp/shadow.h"

namespace cgsr {
namespace {

using hal::CanFrame;
using test::frame;
using test::FuzzBus;
using test::Random;
using test::Shadow;

/// A healthy base's set of messages, damaged now and then, with strangers among them.
class Sender {
 public:
  explicit Sender(std::uint64_t seed) : random_(seed) {}

  std::vector<CanFrame> set() {
    if (random_.whole(0, 299) == 0) wild_sets_ = static_cast<int>(random_.whole(1, 40));
    if (wild_sets_ > 0) {
      --wild_sets_;
      return wild();
    }
    ++servo_;
    auto frames = std::vector{frame("401#0005000100020000"), motion(),
                              frame("404#0000000000000000"), frame("406#00020000018A0130"),
                              frame("680#0005008000000000"), frame("407#0000000000000000")};
    if (random_.whole(0, 499) == 0) damage(frames[static_cast<std::size_t>(random_.whole(0, 5))]);
    return frames;
  }

  Random& random() { return random_; }

 private:
  CanFrame motion() {
    CanFrame moving = frame("402#0000000000000000");
    moving.data[6] = static_cast<std::uint8_t>(servo_ >> 8);
    moving.data[7] = static_cast<std::uint8_t>(servo_);
    return moving;
  }

  void damage(CanFrame& one) {
    one.data[static_cast<std::size_t>(random_.whole(0, 7))] ^= static_cast<std::uint8_t>(1 << random_.whole(0, 7));
  }

  std::vector<CanFrame> wild() {
    constexpr std::array<std::uint16_t, 14> kIds{0x400, 0x401, 0x402, 0x403, 0x404, 0x405, 0x406,
                                                 0x407, 0x412, 0x413, 0x414, 0x680, 0x688, 0x500};
    std::vector<CanFrame> frames(static_cast<std::size_t>(random_.whole(0, 12)));
    for (CanFrame& one : frames) {
      one.id = kIds[static_cast<std::size_t>(random_.whole(0, 13))];
      if (random_.whole(0, 9) == 0) one.id = static_cast<std::uint16_t>(random_.whole(0, 0x7FF));
      one.size = static_cast<std::uint8_t>(random_.whole(0, 9) == 0 ? random_.whole(0, 8) : 8);
      for (std::size_t i = 0; i < one.size; ++i) one.data[i] = static_cast<std::uint8_t>(random_.whole(0, 255));
    }
    return frames;
  }

  Random random_;
  std::uint16_t servo_ = 0;
  int wild_sets_ = 0;
};

struct Outcome {
  std::uint64_t frames = 0;
  std::uint64_t motions = 0;  ///< commands other than zero.
  std::uint64_t rearmed = 0;
};

void check_sent(FuzzBus& bus, const Shadow& shadow, MonoTime now, Outcome& outcome) {
  for (const CanFrame& command : bus.sent) {
    ASSERT_EQ(command.id, 0x413);
    const auto slot = [&command](std::size_t i) {
      return static_cast<std::int16_t>(command.data[i] << 8 | command.data[i + 1]);
    };
    ASSERT_LE(std::abs(slot(0)), 1176);
    ASSERT_LE(std::abs(slot(2)), 1024);
    if (slot(0) == 0 && slot(2) == 0) continue;
    ++outcome.motions;
    ASSERT_TRUE(shadow.motion_allowed(now)) << test::candump(command) << " after " << outcome.frames << " frames";
  }
  bus.sent.clear();
}

void check_odometry(const hal::Odometry& odometry) {
  const hal::rmp::RmpParameters bounds;
  ASSERT_TRUE(std::isfinite(odometry.x_m) && std::isfinite(odometry.y_m) && std::isfinite(odometry.heading_rad));
  ASSERT_LE(std::abs(odometry.velocity.forward_mps), bounds.max_plausible_mps);
  ASSERT_LE(std::abs(odometry.velocity.left_radps), bounds.max_plausible_radps);
  ASSERT_LE(std::abs(odometry.pitch_rad), 1.6);
}

/// One cycle of 10 ms: what arrives, and what the motion loop may call.
void cycle(Sender& sender, FuzzBus& bus, hal::rmp::RmpDrive& drive, Shadow& shadow, MonoTime now, Outcome& outcome) {
  Random& random = sender.random();
  for (CanFrame& arriving : sender.set()) {
    arriving.stamp = now;
    shadow.arrived(arriving, now);
    bus.waiting.push_back(arriving);
    ++outcome.frames;
  }
  if (random.whole(0, 29) == 0 && drive.rearm(now)) {
    shadow.rearmed();
    ++outcome.rearmed;
  }
  const auto odometry = drive.odometry(now);
  shadow.judge(now, drive.fault());
  check_sent(bus, shadow, now, outcome);
  if (odometry) check_odometry(*odometry);
  if (now.time_since_epoch() / seconds(0.3) % 7 == 3)
    return;  // the motion loop hangs: nothing is commanded for a while
  hal::Twist twist{random.real(-6.0, 6.0), random.real(-6.0, 6.0)};
  if (random.whole(0, 99) == 0) twist.forward_mps = std::numeric_limits<double>::quiet_NaN();
  shadow.commanded(now);
  static_cast<void>(drive.command(twist, now));
  shadow.judge(now, drive.fault());
  check_sent(bus, shadow, now, outcome);
}

Outcome run(std::uint64_t seed, std::uint64_t frames) {
  auto owned = std::make_unique<FuzzBus>();
  FuzzBus& bus = *owned;
  hal::rmp::RmpDrive drive(std::move(owned), {});
  EXPECT_TRUE(drive.start());
  Sender sender(seed);
  Shadow shadow;
  Outcome outcome;
  for (MonoTime now{seconds(100.0)}; outcome.frames < frames && !testing::Test::HasFatalFailure();
       now += seconds(0.010)) {
    cycle(sender, bus, drive, shadow, now, outcome);
  }
  return outcome;
}

// CGSR_FUZZ_FRAMES: how many; the short form takes a second or two.
TEST(RmpDriveFuzz, NothingButZeroWhileLatchedSilentIntrudedOrOlderThanTheDeadMan) {
  const char* wanted = std::getenv("CGSR_FUZZ_FRAMES");
  const std::uint64_t frames = wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 400'000;
  std::uint64_t done = 0;
  std::uint64_t motions = 0;
  std::uint64_t rearmed = 0;
  for (std::uint64_t seed = 1; done < frames; ++seed) {
    const Outcome outcome = run(seed, std::min<std::uint64_t>(frames - done, 200'000));
    if (HasFatalFailure()) FAIL() << "seed " << seed;
    done += outcome.frames;
    motions += outcome.motions;
    rearmed += outcome.rearmed;
  }
  RecordProperty("frames", std::to_string(done));
  EXPECT_GT(motions, frames / 200) << "the robot moves between its troubles, else this shows nothing";
  EXPECT_GT(rearmed, frames / 20000);
}

}  // namespace
}  // namespace cgsr
