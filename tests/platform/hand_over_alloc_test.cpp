#include <gtest/gtest.h>

#include <memory>

#include "platform/clock.h"
#include "platform/image_lease.h"
#include "platform/ring.h"
#include "platform/service.h"
#include "platform/stop.h"
#include "platform/wake_up.h"
#include "tests/support/allocation_guard.h"

namespace cgsr {
namespace {

class NoLender final : public ImageLender {
  void give_back(int /*slot*/) noexcept override {}
};

struct Record {
  std::array<char, 4096> bytes{};
};

// A frame's worth of every primitive, 1000 times, straight after construction: rings write their storage when they are
// made, so not even their first lap meets a new page.
TEST(HandOverAlloc, PrimitivesNeitherAllocateNorFault) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  NoLender lender;
  const auto records = std::make_unique<Ring<Record, 256, Overflow::kDiscard>>();  // 1 MiB: fresh from the kernel
  const auto leases = std::make_unique<Ring<ImageLease, 4>>();
  Heartbeats heartbeats;
  WakeUp wake_up;
  StopRequest stop;
  RealClock clock;
  Periodic periodic(clock, std::chrono::microseconds(10));
  SimulatedClock simulated;
  const auto heartbeat = heartbeats.add("vision", std::chrono::seconds(1), clock.now());
  const auto cycle = [&] {
    for (int i = 0; i < 8; ++i) static_cast<void>(leases->push(ImageLease(lender, i, {}, 0, {})));
    static_cast<void>(leases->pop_newest());
    records->push(Record{});
    wake_up.wake();
    static_cast<void>(wake_up.wait_until(clock.now() + std::chrono::seconds(1)));
    heartbeats.beat(heartbeat, clock.now());
    simulated.advance(std::chrono::milliseconds(1));
    simulated.sleep_until(simulated.now());
    periodic.wait();
    return stop.requested();
  };
  for (int i = 0; i < 3; ++i) cycle();  // resolves the library's symbols and touches this test's own stack

  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) cycle();
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.page_faults(), 0U);
}

}  // namespace
}  // namespace cgsr
