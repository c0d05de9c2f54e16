#include "pipeline/runtime/motion_stop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "pipeline/runtime/schedule.h"
#include "tests/support/stress.h"

namespace cgsr::runtime {
namespace {

TEST(MotionStop, StandsUntilItIsLowered) {
  MotionStop stop;
  EXPECT_EQ(stop.look(), 0U);
  stop.raise(3);
  EXPECT_EQ(stop.look(), 1U << 3);
  EXPECT_EQ(stop.look(), 1U << 3);
  stop.lower(3);
  EXPECT_EQ(stop.look(), 0U);
}

TEST(MotionStop, IsSeenOnceEvenIfItWasLoweredBetweenTwoLooks) {
  MotionStop stop;
  stop.raise(0);
  stop.lower(0);
  EXPECT_EQ(stop.look(), 1U);
  EXPECT_EQ(stop.look(), 0U);
}

TEST(MotionStop, KeepsRowsApart) {
  MotionStop stop;
  stop.raise(0);
  stop.raise(kMostStages - 1);
  stop.lower(0);
  EXPECT_EQ(stop.look(), 1U | 1U << (kMostStages - 1));
  EXPECT_EQ(stop.look(), 1U << (kMostStages - 1));
}

// Every raise is met by a look, however the threads interleave: the reader waits for each before the writer goes on.
TEST(MotionStopStress, NoRaiseIsMissed) {
  const auto rounds = std::max<std::uint64_t>(test::stress_handovers() / 10, 1000);  // each waits for the other thread
  MotionStop stop;
  std::atomic<std::uint64_t> met{0};
  std::thread vision([&] {
    for (std::uint64_t i = 0; i < rounds; ++i) {
      stop.raise(i % kMostStages);
      stop.lower(i % kMostStages);
      while (met.load(std::memory_order_acquire) <= i) std::this_thread::yield();
    }
  });
  std::uint64_t wrong = 0;
  while (met < rounds) {
    const auto rows = stop.look();
    if (rows == 0) {
      std::this_thread::yield();
      continue;
    }
    const auto round = met.load(std::memory_order_relaxed);
    wrong += rows == 1U << (round % kMostStages) ? 0 : 1;
    // Standing when looked at: wait for the lowering, so that the next look is about the next round.
    while (stop.look() != 0) std::this_thread::yield();
    met.store(round + 1, std::memory_order_release);
  }
  vision.join();
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace cgsr::runtime
