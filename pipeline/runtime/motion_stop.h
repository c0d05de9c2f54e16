#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace cgsr::runtime {

/// The stages of the safety chain that want the robot to stop: a bit per row of the schedule, written by the vision
/// thread and read by the motion thread. What was raised and lowered between two looks is still seen once, so that a
/// short overrun is not missed.
///
/// Memory orders. One word holds everything and orders nothing else: its own modification order is enough, hence
/// relaxed.
class MotionStop {
 public:
  /// Vision thread.
  void raise(std::size_t row) noexcept { word_.fetch_or(standing(row) | unseen(row), std::memory_order_relaxed); }
  void lower(std::size_t row) noexcept { word_.fetch_and(~standing(row), std::memory_order_relaxed); }

  /// Motion thread. \return the rows, as bits, that stand now or stood since the last look; 0: the chain is well.
  std::uint32_t look() noexcept {
    const auto word = word_.fetch_and(kStanding, std::memory_order_relaxed);
    return static_cast<std::uint32_t>(word | word >> 32);
  }

 private:
  static constexpr std::uint64_t kStanding = 0xffff'ffff;
  static constexpr std::uint64_t standing(std::size_t row) { return std::uint64_t{1} << row; }
  static constexpr std::uint64_t unseen(std::size_t row) { return standing(row) << 32; }

  std::atomic<std::uint64_t> word_{0};
};

}  // namespace cgsr::runtime
