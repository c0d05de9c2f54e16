// Any frames, at any time, between calls in any order: what leaves is in its range, and is zero whenever the shadow model forbids motion.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <memory>
#include <vector>

#include "hal/rmp/rmp_drive.h"
#include "tests/fuzz/bytes.h"
#include "tests/rmp/frames.h"
#include "tests/rmp/shadow.h"

namespace cgsr {
namespace {

constexpr int kMostForward = 1176;  // of the command's slots
constexpr int kMostTurn = 1024;

void check(bool holds) {
  if (!holds) std::abort();
}

/// A drive on a bus, and what may be sent on it. Time goes on by a control cycle with each step.
class Bench {
 public:
  Bench() {
    auto owned = std::make_unique<test::FuzzBus>();
    bus_ = owned.get();
    drive_ = std::make_unique<hal::rmp::RmpDrive>(std::move(owned), hal::rmp::RmpParameters{});
    check(drive_->start().has_value());
  }

  void healthy(std::size_t damaged, std::size_t at, std::uint8_t mask) {
    ++servo_;
    std::vector<hal::CanFrame> frames{test::frame("401#0005000100020000"), test::frame("402#0000000000000000"),
                                      test::frame("404#0000000000000000"), test::frame("406#00020000018A0130"),
                                      test::frame("680#0005008000000000"), test::frame("407#0000000000000000")};
    frames[1].data[6] = static_cast<std::uint8_t>(servo_ >> 8);
    frames[1].data[7] = static_cast<std::uint8_t>(servo_);
    frames[damaged % frames.size()].data.at(at % 8) ^= mask;
    for (const hal::CanFrame& frame : frames) arrive(frame);
  }

  void arrive(hal::CanFrame frame) {
    frame.stamp = now_;
    shadow_.arrived(frame, now_);
    bus_->waiting.push_back(frame);
  }

  void rearm() {
    if (drive_->rearm(now_)) shadow_.rearmed();
  }

  void wait(std::uint8_t ms) { now_ += seconds(1e-3 * ms); }

  void cycle(const hal::Twist& twist) {
    now_ += seconds(0.010);
    const auto odometry = drive_->odometry(now_);
    judge();
    if (odometry) {
      const hal::rmp::RmpParameters bounds;
      check(std::isfinite(odometry->x_m) && std::isfinite(odometry->y_m) && std::isfinite(odometry->heading_rad));
      check(std::abs(odometry->velocity.forward_mps) <= bounds.max_plausible_mps);
      check(std::abs(odometry->velocity.left_radps) <= bounds.max_plausible_radps);
      check(std::abs(odometry->pitch_rad) <= 1.6);
    }
    shadow_.commanded(now_);
    static_cast<void>(drive_->command(twist, now_));
    judge();
  }

 private:
  void judge() {
    shadow_.judge(now_, drive_->fault());
    for (const hal::CanFrame& command : bus_->sent) {
      const auto slot = [&command](std::size_t i) {
        return static_cast<std::int16_t>(command.data[i] << 8 | command.data[i + 1]);
      };
      check(command.id == 0x413 && command.size == 8);
      check(std::abs(slot(0)) <= kMostForward && std::abs(slot(2)) <= kMostTurn);
      check((slot(0) == 0 && slot(2) == 0) || shadow_.motion_allowed(now_));
    }
    bus_->sent.clear();
  }

  test::FuzzBus* bus_ = nullptr;
  std::unique_ptr<hal::rmp::RmpDrive> drive_;
  test::Shadow shadow_;
  MonoTime now_{seconds(100.0)};
  std::uint16_t servo_ = 0;
};

void play(test::Bytes bytes) {
  Bench bench;
  while (!bytes.empty()) {
    hal::Twist twist{0.05 * bytes.whole(-128, 127), 0.05 * bytes.whole(-128, 127)};
    switch (bytes.whole(0, 7)) {
      case 0:
        for (int set = bytes.whole(0, 63); set > 0; --set) {  // ten in a row end a latched fault
          bench.healthy(0, 0, 0);
          bench.cycle(twist);
        }
        break;
      case 1:
        bench.healthy(bytes.byte(), bytes.byte(), bytes.byte());
        break;
      case 2:
        bench.wait(bytes.byte());
        break;
      case 3:
        bench.rearm();
        break;
      case 4:
        twist.forward_mps = std::numeric_limits<double>::quiet_NaN();
        break;
      default: {
        hal::CanFrame frame;
        frame.id = static_cast<std::uint16_t>((bytes.byte() << 8 | bytes.byte()) & 0x7FF);
        frame.size = static_cast<std::uint8_t>(bytes.whole(0, 8));
        for (std::size_t i = 0; i < frame.size; ++i) frame.data[i] = bytes.byte();
        bench.arrive(frame);
      }
    }
    bench.cycle(twist);
  }
}

}  // namespace
}  // namespace cgsr

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  cgsr::play({data, size});
  return 0;
}
