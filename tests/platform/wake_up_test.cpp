#include "platform/wake_up.h"

#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "platform/clock.h"

namespace cgsr {
namespace {

using std::chrono::milliseconds;

TEST(WakeUp, GivesUpAtItsDeadlineAndNotBefore) {
  WakeUp wake_up;
  const RealClock clock;
  const auto deadline = clock.now() + milliseconds(20);
  EXPECT_FALSE(wake_up.wait_until(deadline));
  EXPECT_GE(clock.now(), deadline);
}

TEST(WakeUp, APastDeadlineOnlyAsks) {
  WakeUp wake_up;
  EXPECT_FALSE(wake_up.wait_until(MonoTime::min()));
  wake_up.wake();
  EXPECT_TRUE(wake_up.wait_until(MonoTime::min()));
}

TEST(WakeUp, IsRememberedOnceHoweverOftenItComes) {
  WakeUp wake_up;
  for (int i = 0; i < 5; ++i) wake_up.wake();
  EXPECT_TRUE(wake_up.wait_until(MonoTime{}));
  EXPECT_FALSE(wake_up.wait_until(MonoTime{}));
}

TEST(WakeUp, WakesAThreadThatWaits) {
  WakeUp wake_up;
  const RealClock clock;
  std::thread waker([&] {
    std::this_thread::sleep_for(milliseconds(10));
    wake_up.wake();
  });
  EXPECT_TRUE(wake_up.wait_until(clock.now() + std::chrono::seconds(30)));
  waker.join();
}

WakeUp* of_handler = nullptr;

TEST(WakeUp, MayBeUsedInASignalHandler) {
  WakeUp wake_up;
  of_handler = &wake_up;
  struct sigaction action {};
  struct sigaction former {};
  action.sa_handler = [](int) { of_handler->wake(); };
  sigaction(SIGUSR1, &action, &former);
  errno = ENOENT;
  raise(SIGUSR1);
  EXPECT_EQ(errno, ENOENT);
  EXPECT_TRUE(wake_up.wait_until(MonoTime{}));
  sigaction(SIGUSR1, &former, nullptr);
}

// A signal in the middle of the wait neither ends it nor shortens it.
TEST(WakeUp, SleepsOnAfterAnInterruption) {
  WakeUp wake_up;
  struct sigaction action {};
  struct sigaction former {};
  action.sa_handler = [](int) {};
  sigaction(SIGUSR1, &action, &former);
  const RealClock clock;
  const auto deadline = clock.now() + milliseconds(60);
  bool woken = true;
  std::thread waiter([&] { woken = wake_up.wait_until(deadline); });
  std::this_thread::sleep_for(milliseconds(20));
  pthread_kill(waiter.native_handle(), SIGUSR1);
  waiter.join();
  EXPECT_FALSE(woken);
  EXPECT_GE(clock.now(), deadline);
  sigaction(SIGUSR1, &former, nullptr);
}

}  // namespace
}  // namespace cgsr
