#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "pipeline/runtime/robot_threads.h"
#include "platform/clock.h"

namespace cgsr::runtime {
namespace {

TEST(RobotThreads, AllStartAndStopTogether) {
  StopRequest stop;
  ThreadTable threads(stop);
  RealClock clock;
  const auto body = [&] {
    // Real-time threads that did not sleep would take the machine.
    for (Periodic cycle(clock, std::chrono::milliseconds(1)); !stop.requested();) cycle.wait();
  };
  for (const auto& spec : kRobotThreads) ASSERT_TRUE(threads.start(spec, body)) << spec.name;
  threads.stop_and_join();
  EXPECT_EQ(threads.report().size(), kRobotThreads.size());
}

// The wheels come before the eyes, the eyes before everything that may wait; nobody reaches the kernel's own
// priorities.
TEST(RobotThreads, PrioritiesAreInOrder) {
  EXPECT_GT(kMotionThread.priority, kCaptureThread.priority);
  EXPECT_GT(kCaptureThread.priority, kVisionThread.priority);
  EXPECT_EQ(kSwitchThread.policy, SchedulingPolicy::kOther);
  EXPECT_EQ(kHousekeepingThread.policy, SchedulingPolicy::kOther);
  std::set<std::string_view> names;
  for (const auto& spec : kRobotThreads) names.insert(spec.name);
  EXPECT_EQ(names.size(), kRobotThreads.size());
}

}  // namespace
}  // namespace cgsr::runtime
