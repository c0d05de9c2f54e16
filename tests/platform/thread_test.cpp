#include "platform/thread.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <alloca.h>

#include <array>
#include <atomic>
#include <string>

#include "platform/clock.h"
#include "platform/memory.h"
#include "tests/support/allocation_guard.h"

namespace cgsr {
namespace {

using testing::ExitedWithCode;
using testing::HasSubstr;

constexpr ThreadSpec kOrdinary{"worker", SchedulingPolicy::kOther, 0, 256 * 1024, 0};
constexpr ThreadSpec kUrgent{"motion", SchedulingPolicy::kFifo, 70, 256 * 1024, 0};

TEST(ThreadTable, RunsBodiesUntilTheStopAndJoinsThem) {
  StopRequest stop;
  std::atomic<int> ended{0};
  {
    ThreadTable threads(stop);
    const auto body = [&] {
      while (!stop.requested()) sched_yield();
      ++ended;
    };
    ASSERT_TRUE(threads.start(kOrdinary, body));
    ASSERT_TRUE(threads.start(kOrdinary, body));
    threads.stop_and_join();
    EXPECT_EQ(ended, 2);
    threads.stop_and_join();
  }
  EXPECT_EQ(ended, 2);
  EXPECT_TRUE(stop.requested());
}

TEST(ThreadTable, WakesWhoWaitsWhenItStops) {
  StopRequest stop;
  WakeUp wake;
  ThreadTable threads(stop);
  const auto wait = [&] {
    while (!stop.requested()) wake.wait();
  };
  ASSERT_TRUE(threads.start(kOrdinary, wait, &wake));
  const RealClock clock;
  const auto before = clock.now();
  threads.stop_and_join();
  EXPECT_LT(clock.now() - before, std::chrono::seconds(5));
}

TEST(ThreadTable, GivesTheThreadItsNameAndStack) {
  StopRequest stop;
  ThreadTable threads(stop);
  std::string name;
  std::size_t stack_bytes = 0;
  ASSERT_TRUE(threads.start({"a-long-name-15c", SchedulingPolicy::kOther, 0, 384 * 1024, 0}, [&] {
    while (!stop.requested()) sched_yield();
    std::array<char, 16> buffer{};
    pthread_getname_np(pthread_self(), buffer.data(), buffer.size());
    name = buffer.data();
    pthread_attr_t attributes;
    pthread_getattr_np(pthread_self(), &attributes);
    pthread_attr_getstacksize(&attributes, &stack_bytes);
    pthread_attr_destroy(&attributes);
  }));
  threads.stop_and_join();
  EXPECT_EQ(name, "a-long-name-15c");
  EXPECT_GE(stack_bytes, 384U * 1024U);
  if (!test::AllocationGuard::counts()) return;  // a sanitizer adds its own
  EXPECT_LT(stack_bytes, 2U * 384U * 1024U);
}

// Deep calls in the body meet no page that was not there before.
TEST(ThreadTable, StackIsTouchedBeforeTheBodyRuns) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer has a stack of its own";
  StopRequest stop;
  ThreadTable threads(stop);
  long faults = -1;
  ASSERT_TRUE(threads.start({"deep", SchedulingPolicy::kOther, 0, 1024 * 1024, 0}, [&] {
    const long before = page_faults_of_this_thread();
    prefault_stack(900 * 1024);
    faults = page_faults_of_this_thread() - before;
  }));
  threads.stop_and_join();
  EXPECT_EQ(faults, 0);
}

TEST(ThreadTable, RefusesWhatCannotBe) {
  StopRequest stop;
  ThreadTable threads(stop);
  const auto error_of = [&](const ThreadSpec& spec) {
    const auto started = threads.start(spec, [] {});
    return started ? std::string() : started.error().message;
  };
  EXPECT_THAT(error_of({"sixteen-letters!", SchedulingPolicy::kOther, 0}), HasSubstr("1..15 characters"));
  EXPECT_THAT(error_of({"", SchedulingPolicy::kOther, 0}), HasSubstr("1..15 characters"));
  EXPECT_THAT(error_of({"vision", SchedulingPolicy::kFifo, 90}),
              HasSubstr("thread 'vision': priority 90 is not in 1..89"));
  EXPECT_THAT(error_of({"vision", SchedulingPolicy::kFifo, 0}), HasSubstr("1..89"));
  EXPECT_THAT(error_of({"vision", SchedulingPolicy::kOther, 5}), HasSubstr("0..0"));
  EXPECT_THAT(error_of({"vision", SchedulingPolicy::kOther, 0, 4096}),
              HasSubstr("thread 'vision': a stack of 4096 bytes"));
  EXPECT_TRUE(threads.report().empty());
}

// What the report says is what the kernel says, with rights or without.
TEST(ThreadTable, ReportsThePolicyThatTookEffect) {
  StopRequest stop;
  ThreadTable threads(stop);
  int policy = -1;
  sched_param parameters{};
  ASSERT_TRUE(threads.start(kUrgent, [&] { pthread_getschedparam(pthread_self(), &policy, &parameters); }));
  threads.stop_and_join();
  const auto report = threads.report();
  ASSERT_EQ(report.size(), 1U);
  EXPECT_EQ(report[0].policy == SchedulingPolicy::kFifo, policy == SCHED_FIFO);
  EXPECT_EQ(report[0].priority, parameters.sched_priority);
  EXPECT_EQ(report[0].remark.empty(), policy == SCHED_FIFO);
}

[[noreturn]] void run_without_rights() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_RTPRIO, &none);
  if (setuid(65534) != 0 && geteuid() == 0) std::exit(2);
  StopRequest stop;
  ThreadTable threads(stop);
  std::atomic<bool> ran{false};
  if (!threads.start(kUrgent, [&] { ran = true; })) std::exit(3);
  threads.stop_and_join();
  std::fputs(to_text(threads.report()).c_str(), stderr);
  std::exit(ran ? 0 : 1);
}

TEST(ThreadTableDeathTest, WithoutRightsTheSameThreadsRunAndTheTableSaysSo) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(run_without_rights(), ExitedWithCode(0),
              "motion +SCHED_OTHER +0 +256 +0\n"
              "motion asked for SCHED_FIFO 70: SCHED_FIFO is not permitted .RLIMIT_RTPRIO 0.; LimitRTPRIO=80 or");
}

}  // namespace
}  // namespace cgsr
