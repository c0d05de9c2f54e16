#include "platform/stop.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <thread>

#include "platform/clock.h"

namespace cgsr {
namespace {

TEST(StopRequest, IsFinalAndEndsTheWait) {
  StopRequest stop;
  const RealClock clock;
  EXPECT_FALSE(stop.requested());
  EXPECT_FALSE(stop.wait_until(clock.now() + std::chrono::milliseconds(5)));
  std::thread other([&] { stop.request(); });
  EXPECT_TRUE(
      stop.wait_until(clock.now() + std::chrono::seconds(5)));  // the thread sanitizer hands signals over at its end
  other.join();
  EXPECT_TRUE(stop.requested());
  EXPECT_TRUE(stop.wait_until(MonoTime{}));
  EXPECT_TRUE(stop.wait_until(MonoTime{}));
}

class StopOnSignalsTest : public testing::TestWithParam<int> {};

TEST_P(StopOnSignalsTest, RequestsTheStop) {
  StopRequest stop;
  const StopOnSignals signals(stop);
  EXPECT_EQ(StopOnSignals::received(), 0);
  raise(GetParam());
  EXPECT_TRUE(stop.requested());
  EXPECT_EQ(StopOnSignals::received(), GetParam());
}

// As the service meets it: the signal comes from outside while the service thread waits.
TEST_P(StopOnSignalsTest, WakesTheServiceThread) {
  StopRequest stop;
  const StopOnSignals signals(stop);
  const RealClock clock;
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    kill(getpid(), GetParam());
  });
  EXPECT_TRUE(
      stop.wait_until(clock.now() + std::chrono::seconds(5)));  // the thread sanitizer hands signals over at its end
  other.join();
}

INSTANTIATE_TEST_SUITE_P(All, StopOnSignalsTest, testing::Values(SIGTERM, SIGINT, SIGHUP));

int seen_by_former_handler = 0;

TEST(StopOnSignals, GivesTheSignalsBack) {
  struct sigaction action {};
  struct sigaction former {};
  action.sa_handler = [](int signal) { seen_by_former_handler = signal; };
  sigaction(SIGTERM, &action, &former);
  StopRequest stop;
  { const StopOnSignals signals(stop); }
  raise(SIGTERM);
  EXPECT_EQ(seen_by_former_handler, SIGTERM);
  EXPECT_FALSE(stop.requested());
  sigaction(SIGTERM, &former, nullptr);
}

TEST(StopOnSignals, LeavesAHangUpIgnoredThatNohupIgnores) {
  struct sigaction former {};
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGHUP, &ignore, &former);
  {
    StopRequest stop;
    const StopOnSignals signals(stop);
    raise(SIGHUP);
    EXPECT_FALSE(stop.requested());
  }
  sigaction(SIGHUP, &former, nullptr);
}

// `cgsr run | head`: the robot goes on when its reader is gone.
TEST(StopOnSignals, OutlivesWhoeverReadsItsOutput) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  close(ends[0]);
  StopRequest stop;
  {
    const StopOnSignals signals(stop);
    EXPECT_EQ(write(ends[1], "line", 4), -1);
    EXPECT_EQ(errno, EPIPE);
    EXPECT_FALSE(stop.requested());
  }
  EXPECT_EXIT(static_cast<void>(write(ends[1], "line", 4)), testing::KilledBySignal(SIGPIPE), "") << "as before";
  close(ends[1]);
}

TEST(EndAtOnceOnSignals, EndsTheProcessWhileItLivesAndNotAfterwards) {
  StopRequest stop;
  const StopOnSignals signals(stop);
  const auto end_while_loading = [] {
    const EndAtOnceOnSignals loading(3);
    raise(SIGTERM);
  };
  EXPECT_EXIT(end_while_loading(), testing::ExitedWithCode(3), "while loading");
  { const EndAtOnceOnSignals loading(3); }
  raise(SIGTERM);
  EXPECT_TRUE(stop.requested());
  EXPECT_EXIT(EndAtOnceOnSignals(3), testing::ExitedWithCode(3), "while loading");  // one that came before
}

}  // namespace
}  // namespace cgsr
