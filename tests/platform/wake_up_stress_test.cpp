#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "platform/clock.h"
#include "platform/ring.h"
#include "platform/wake_up.h"
#include "tests/support/stress.h"

namespace cgsr {
namespace {

constexpr auto kLostForSure = std::chrono::seconds(60);

// Two threads in turn, with a plain variable between them: the wake-up alone makes its value visible (the thread
// sanitizer watches).
TEST(WakeUpStress, PingPongCarriesWhatWasWrittenBefore) {
  const auto rounds = std::max<std::uint64_t>(test::stress_handovers() / 20, 1000);
  WakeUp ping;
  WakeUp pong;
  std::uint64_t ball = 0;
  const RealClock clock;
  std::thread other([&] {
    for (std::uint64_t i = 0; i < rounds; ++i) {
      if (!ping.wait_until(clock.now() + kLostForSure)) return;
      ++ball;
      pong.wake();
    }
  });
  bool lost = false;
  for (std::uint64_t i = 0; i < rounds && !lost; ++i) {
    ++ball;
    ping.wake();
    lost = !pong.wait_until(clock.now() + kLostForSure);
    if (ball != 2 * (i + 1)) break;
  }
  other.join();
  EXPECT_FALSE(lost);
  EXPECT_EQ(ball, 2 * rounds);
}

// The way the loops use it: the producer pushes, then wakes; the consumer empties the ring, then waits. A lost wake-up
// would leave the last values lying there until the deadline.
TEST(WakeUpStress, NoWakeUpIsLostBetweenLookingAndWaiting) {
  const auto count = test::stress_handovers();
  Ring<std::uint64_t, 16> ring;
  WakeUp wake_up;
  const RealClock clock;
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < count; ++i) {
      while (!ring.push(std::uint64_t{i})) std::this_thread::yield();
      wake_up.wake();
    }
  });
  std::uint64_t received = 0;
  bool lost = false;
  while (received < count && !lost) {
    if (ring.pop()) {
      ++received;
    } else {
      lost = !wake_up.wait_until(clock.now() + kLostForSure);
    }
  }
  while (received < count) received += ring.pop() ? 1 : 0;  // let the producer end, also when the test fails
  producer.join();
  EXPECT_FALSE(lost);
}

}  // namespace
}  // namespace cgsr
