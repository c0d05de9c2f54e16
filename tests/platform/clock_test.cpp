#include "platform/clock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace cgsr {
namespace {

using std::chrono::milliseconds;

constexpr MonoTime at(Duration since_start) {
  return MonoTime{since_start};
}

TEST(RealClock, NeverFallsAndSleepsLongEnough) {
  RealClock clock;
  const auto before = clock.now();
  clock.sleep_until(before + milliseconds(5));
  EXPECT_GE(clock.now() - before, milliseconds(5));
}

TEST(RealClock, DoesNotSleepForATimeThatHasPassed) {
  RealClock clock;
  const auto before = clock.now();
  clock.sleep_until(before - milliseconds(500));
  clock.sleep_until(MonoTime::min());
  EXPECT_LT(clock.now() - before, milliseconds(250));
}

TEST(SimulatedClock, StandsStillUntilItIsMoved) {
  SimulatedClock clock(at(milliseconds(100)));
  EXPECT_EQ(clock.now(), at(milliseconds(100)));
  EXPECT_EQ(clock.now(), at(milliseconds(100)));
  clock.advance(milliseconds(7));
  EXPECT_EQ(clock.now(), at(milliseconds(107)));
}

TEST(SimulatedClock, NeverFalls) {
  SimulatedClock clock(at(milliseconds(100)));
  clock.advance_to(at(milliseconds(50)));
  clock.advance(milliseconds(-1));
  EXPECT_EQ(clock.now(), at(milliseconds(100)));
}

TEST(SimulatedClock, WakesASleeperWhenItsTimeHasComeAndNotBefore) {
  SimulatedClock clock;
  std::atomic<bool> awake{false};
  std::thread sleeper([&] {
    clock.sleep_until(at(milliseconds(10)));
    EXPECT_GE(clock.now(), at(milliseconds(10)));
    awake = true;
  });
  clock.advance_to(at(milliseconds(9)));
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_FALSE(awake);
  clock.advance_to(at(milliseconds(10)));
  sleeper.join();
  EXPECT_TRUE(awake);
}

TEST(SimulatedClock, LetsEverySleeperGoWhenItEnds) {
  SimulatedClock clock;
  std::thread sleeper([&] { clock.sleep_until(MonoTime::max()); });
  clock.end();
  sleeper.join();
  clock.sleep_until(MonoTime::max());  // and whoever comes later
  EXPECT_EQ(clock.now(), MonoTime{});
}

// A driver and three sleepers on a grid of their own: nobody oversleeps for good, nobody wakes early.
TEST(SimulatedClockStress, ManySleepersOneDriver) {
  SimulatedClock clock;
  std::atomic<int> running{3};
  const auto sleep_on_grid = [&](Duration period) {
    for (int i = 1; i <= 300; ++i) {
      clock.sleep_until(at(i * period));
      EXPECT_GE(clock.now(), at(i * period));
    }
    --running;
  };
  std::thread fast(sleep_on_grid, milliseconds(3));
  std::thread middle(sleep_on_grid, milliseconds(10));
  std::thread slow(sleep_on_grid, milliseconds(33));
  while (running > 0) clock.advance(milliseconds(1));
  fast.join();
  middle.join();
  slow.join();
}

/// A clock for one thread: sleeping moves it.
class SleepMovesIt final : public Clock {
 public:
  [[nodiscard]] MonoTime now() const override { return now_; }
  void sleep_until(MonoTime wake_up_at) override { now_ = std::max(now_, wake_up_at); }
  void work(Duration duration) { now_ += duration; }

 private:
  MonoTime now_{};
};

TEST(Periodic, KeepsItsGridWhateverTheWorkTakes) {
  SleepMovesIt clock;
  Periodic periodic(clock, milliseconds(10));
  for (int i = 1; i <= 5; ++i) {
    EXPECT_EQ(periodic.wait(), at(i * milliseconds(10)));
    clock.work(milliseconds(2 * i - 1));
  }
  EXPECT_EQ(periodic.missed(), 0U);
}

TEST(Periodic, LosesWholePeriodsAndDoesNotBurst) {
  SleepMovesIt clock;
  Periodic periodic(clock, milliseconds(10));
  EXPECT_EQ(periodic.wait(), at(milliseconds(10)));
  clock.work(milliseconds(35));  // now 45: 20, 30 are gone for good, 40 is late but not lost
  EXPECT_EQ(periodic.wait(), at(milliseconds(40)));
  EXPECT_EQ(periodic.missed(), 2U);
  EXPECT_EQ(clock.now(), at(milliseconds(45)));
  EXPECT_EQ(periodic.wait(), at(milliseconds(50)));
  EXPECT_EQ(clock.now(), at(milliseconds(50)));
  EXPECT_EQ(periodic.missed(), 2U);
}

}  // namespace
}  // namespace cgsr
