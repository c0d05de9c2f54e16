#pragma once

#include <cstdint>
#include <string_view>

#include "hal/rmp/messages.h"
#include "hal/rmp/scales.h"

namespace cgsr::hal::rmp {

/// Whether the reported yaw rate turns the same way as the wheels (D4: drivers disagree about its sign). Only a turn
/// shows it: a wheel that is faster than the other by more than kMinWheels_mps while the yaw rate is more than
/// kMinYaw_radps. Judged once, at the first turns after the start; slip makes single sets disagree, not most of them.
class YawCheck {
 public:
  enum class Verdict : std::uint8_t { kOpen, kAgrees, kContradicts };

  void take(const Motion& motion, const RmpScales& scales) {
    if (verdict_ != Verdict::kOpen) return;
    const double wheels_mps = (motion.right - motion.left) / scales.velocity_per_mps;
    const double yaw_radps = to_twist(motion, scales).left_radps;
    if (wheels_mps * wheels_mps < kMinWheels_mps * kMinWheels_mps) return;
    if (yaw_radps * yaw_radps < kMinYaw_radps * kMinYaw_radps) return;
    balance_ += (wheels_mps > 0.0) == (yaw_radps > 0.0) ? 1 : -1;
    if (balance_ >= kSets) verdict_ = Verdict::kAgrees;
    if (balance_ <= -kSets) verdict_ = Verdict::kContradicts;
  }

  [[nodiscard]] Verdict verdict() const { return verdict_; }

 private:
  static constexpr double kMinWheels_mps = 0.08;
  static constexpr double kMinYaw_radps = 0.1;
  static constexpr int kSets = 20;  // 0.2 s of turning

  int balance_ = 0;
  Verdict verdict_ = Verdict::kOpen;
};

constexpr std::string_view to_string(YawCheck::Verdict verdict) {
  switch (verdict) {
    case YawCheck::Verdict::kOpen:
      return "open";
    case YawCheck::Verdict::kAgrees:
      return "agrees";
    case YawCheck::Verdict::kContradicts:
      return "contradicts";
  }
  return "";
}

}  // namespace cgsr::hal::rmp
