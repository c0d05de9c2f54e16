// Laws that hold whatever happens on the bus, in whatever order.

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "hal/rmp/rmp_drive.h"
#include "hal/sim/base/wire.h"
#include "tests/rmp/frames.h"
#include "tests/rmp/rig.h"
#include "tests/support/allocation_guard.h"

namespace cgsr {
namespace {

using sim::BaseTrouble;
using sim::BusTrouble;
using test::at;
using test::frame;
using test::kBegin;
using test::Random;
using test::Rig;

constexpr const char* kForeign = "413#0001004D00000000";

struct Trouble {
  MonoTime from;
  MonoTime to;
};

/// A script of troubles of both kinds, some of them overlapping, and when they are.
std::vector<Trouble> random_troubles(Random& random, Rig::Setup& setup, double until_s) {
  std::vector<Trouble> all;
  MonoTime next = at(random.real(1.0, 3.0));
  while (next < at(until_s)) {
    const Trouble trouble{next, next + seconds(random.real(0.2, 1.5))};
    next += seconds(random.real(0.3, 4.0));
    const auto kind = random.whole(0, 10);
    if (kind < 5) {
      setup.base_script.push_back({.trouble = static_cast<BaseTrouble>(kind), .from = trouble.from, .to = trouble.to});
    } else {
      const auto bus = kind == 10 ? BusTrouble::kSecondCommander : static_cast<BusTrouble>(kind - 5);
      setup.bus_script.push_back({.trouble = bus,
                                  .from = trouble.from,
                                  .to = trouble.to,
                                  .frame = frame(bus == BusTrouble::kIdLost ? "401#" : kForeign)});
    }
    all.push_back(trouble);
  }
  return all;
}

// After a trouble began, and the time it may take to notice it has passed, the host says nothing but zero until
// somebody re-armed it after the trouble's end. And it can be re-armed: the robot moves again and again.
TEST(RmpDriveProperty, NeverCommandsMotionBetweenATroubleAndARearming) {
  constexpr Duration kNoticed = seconds(0.16);
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    Random random(seed);
    Rig::Setup setup;
    const auto troubles = random_troubles(random, setup, 25.0);
    bool moved_now = false;
    Rig rig(setup);
    rig.segway.bus().tap([&](const hal::CanFrame& f) {
      const auto order = sim::read_order(f);
      if (order && test::candump(f) != kForeign && (order->velocity_counts != 0 || order->turn_counts != 0))
        moved_now = true;
    });
    MonoTime rearmed_at = MonoTime::min();
    int cycles_in_motion = 0, rearmings = 0;
    while (rig.now < at(30.0)) {
      moved_now = false;
      (void)rig.cycle({.forward_mps = random.real(-0.5, 0.5), .left_radps = random.real(-0.5, 0.5)});
      const bool forbidden = std::any_of(troubles.begin(), troubles.end(), [&](const Trouble& trouble) {
        const bool noticed = trouble.from + kNoticed < rig.now;
        return noticed && (rig.now < trouble.to || rearmed_at < trouble.from);
      });
      // A cable that is plugged in again lets out what its queue still held: that is a property of queues, not of the
      // driver.
      const bool from_queue =
          std::any_of(setup.bus_script.begin(), setup.bus_script.end(), [&](const sim::BusEvent& event) {
            return event.trouble == BusTrouble::kUnplugged && event.to <= rig.now && rig.now < event.to + seconds(0.03);
          });
      if (forbidden && !from_queue) {
        ASSERT_FALSE(moved_now) << "seed " << seed << " at " << to_seconds(rig.now - kBegin);
      }
      cycles_in_motion += moved_now ? 1 : 0;
      if (random.whole(0, 20) == 0 && rig.drive.fault() != hal::DriveFault::kNone && rig.drive.rearm(rig.now)) {
        rearmed_at = rig.now;
        ++rearmings;
      }
    }
    EXPECT_GT(cycles_in_motion, 200) << "seed " << seed;
    EXPECT_GT(rearmings, 1) << "seed " << seed;
  }
}

// Random frames, most of them with ids and sizes that mean something, between those of a running base.
TEST(RmpDriveFuzz, RandomFramesNeverBreakIt) {
  constexpr std::uint16_t kIds[] = {0x400, 0x401, 0x402, 0x403, 0x404, 0x405, 0x406,
                                    0x407, 0x412, 0x413, 0x414, 0x680, 0x688};
  Random random(99);
  Rig rig;
  for (int cycle = 0; cycle < 20000; ++cycle) {
    for (auto count = random.whole(0, 12); count > 0; --count) {
      hal::CanFrame f;
      f.id = random.whole(0, 9) == 0 ? static_cast<std::uint16_t>(random.whole(0, 0x7FF))
                                     : kIds[static_cast<std::size_t>(random.whole(0, std::size(kIds) - 1))];
      f.size = random.whole(0, 9) == 0 ? static_cast<std::uint8_t>(random.whole(0, 8)) : std::uint8_t{8};
      for (std::size_t i = 0; i < f.size; ++i) {
        f.data[i] = random.whole(0, 3) == 0 ? std::uint8_t{0x7F} : static_cast<std::uint8_t>(random.whole(0, 255));
      }
      f.stamp = rig.now;
      rig.segway.bus().inject(f);
    }
    (void)rig.cycle({.forward_mps = random.real(-2.0, 2.0), .left_radps = random.real(-3.0, 3.0)});
    if (random.whole(0, 10) == 0) (void)rig.drive.rearm(rig.now);
    ASSERT_TRUE(std::isfinite(rig.odometry.x_m) && std::isfinite(rig.odometry.y_m) &&
                std::isfinite(rig.odometry.heading_rad));
    ASSERT_LE(std::abs(rig.odometry.velocity.forward_mps), 5.0);
    ASSERT_LE(std::abs(rig.odometry.pitch_rad), 1.6);
    const auto truth = rig.segway.base().state_at(rig.now);
    ASSERT_TRUE(std::isfinite(truth.x_m) && std::isfinite(truth.pitch_rad));
  }
  EXPECT_GT(rig.drive.counters().feedback.undecodable, 1000U);
}

// A second is enough for everything that happens once in a while: a mismatch, a lost set, a fault, a re-arming.
TEST(RmpDriveAlloc, NeitherCommandNorOdometryAllocates) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer owns malloc";
  Rig::Setup setup;
  setup.base_script = {{.trouble = BaseTrouble::kEmergencyStop, .from = at(2.0), .to = at(2.5)}};
  setup.bus_script = {{.trouble = BusTrouble::kBaseSilent, .from = at(4.0), .to = at(4.5)},
                      {.trouble = BusTrouble::kBusOff, .from = at(5.0), .to = at(5.5)}};
  Rig rig(setup);
  (void)rig.run_until(1.0, test::kForward);

  const test::AllocationGuard guard;
  for (int cycle = 0; cycle < 600; ++cycle) {
    (void)rig.cycle(test::kForward);
    if (cycle % 50 == 0) (void)rig.drive.rearm(rig.now);
  }
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
}

}  // namespace
}  // namespace cgsr
