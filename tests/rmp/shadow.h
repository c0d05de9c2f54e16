#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "hal/can_bus.h"
#include "hal/drive.h"
#include "platform/time.h"

namespace cgsr::test {

inline constexpr std::array<std::uint16_t, 5> kNeededMessages{0x401, 0x402, 0x404, 0x406, 0x680};

/// What may leave the computer, by what arrived and what was called.
class Shadow {
 public:
  void arrived(const hal::CanFrame& frame, MonoTime now) {
    const auto needed = std::find(kNeededMessages.begin(), kNeededMessages.end(), frame.id);
    if (needed != kNeededMessages.end() && frame.size == 8)
      last_[static_cast<std::size_t>(needed - kNeededMessages.begin())] = now;
    if (frame.id == 0x413 && frame.size == 8) intruder_ = now;
    if (frame.id == 0x412) intruder_ = now;
    if (frame.id == 0x680 && frame.size == 8) {
      stopped_ = ((frame.data[4] | frame.data[5]) & 0x02) != 0;  // the emergency stop, of either side
      powered_ = (frame.data[3] & 0x80) != 0;
    }
  }

  /// Before each call that may send. A fault of a base that was ready before latches.
  void judge(MonoTime now, hal::DriveFault seen) {
    const bool silent =
        std::any_of(last_.begin(), last_.end(), [now](MonoTime stamp) { return now - stamp > seconds(0.100); });
    const bool intruded = now - intruder_ < seconds(1.0);
    forbidden_ = silent || intruded || stopped_ || !powered_;
    if (ready_ && forbidden_) latched_ = true;
    if (seen == hal::DriveFault::kNone) ready_ = true;
  }

  void rearmed() { latched_ = false; }
  void commanded(MonoTime now) { commanded_ = now; }
  [[nodiscard]] bool motion_allowed(MonoTime now) const {
    return !forbidden_ && !latched_ && now - commanded_ <= seconds(0.150);
  }

 private:
  std::array<MonoTime, kNeededMessages.size()> last_{MonoTime{}, MonoTime{}, MonoTime{}, MonoTime{}, MonoTime{}};
  MonoTime intruder_{seconds(-10.0)};
  MonoTime commanded_{seconds(-10.0)};
  bool stopped_ = false;
  bool powered_ = false;
  bool ready_ = false;
  bool latched_ = false;
  bool forbidden_ = true;
};

/// The driver's end of the bus.
class FuzzBus final : public hal::CanBus {
 public:
  Result<void> start() override { return {}; }
  tl::expected<void, hal::CanSendFailure> send(const hal::CanFrame& frame) override {
    sent.push_back(frame);
    return {};
  }
  std::size_t receive(MonoTime until, std::span<hal::CanFrame> into) override {
    std::size_t count = 0;
    for (; count < into.size() && !waiting.empty() && waiting.front().stamp <= until; ++count) {
      into[count] = waiting.front();
      waiting.pop_front();
    }
    return count;
  }
  [[nodiscard]] hal::CanState state() const override { return hal::CanState::kActive; }
  [[nodiscard]] hal::CanCounters counters() const override { return {}; }
  void stop() override {}

  std::deque<hal::CanFrame> waiting;
  std::vector<hal::CanFrame> sent;
};

}  // namespace cgsr::test
