#include "hal/sim/base/virtual_can_bus.h"

#include <array>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/rmp/frames.h"
#include "tests/rmp/rig.h"

namespace cgsr::sim {
namespace {

using hal::CanSendFailure;
using hal::CanState;
using test::at;
using test::candump;
using test::frame;

constexpr auto kWire = std::chrono::microseconds(222);  // eight bytes at 500 kbit/s

struct Pair {
  explicit Pair(std::vector<BusEvent> script = {}) : bus(std::move(script)), host(bus.host()), base(bus.base()) {
    EXPECT_TRUE(host->start());
    EXPECT_TRUE(base->start());
  }
  static auto send(hal::CanBus& port, const char* text, double s) {
    auto f = frame(text);
    f.stamp = at(s);
    return port.send(f);
  }
  static std::vector<hal::CanFrame> receive(hal::CanBus& port, MonoTime until) {
    std::array<hal::CanFrame, 4> some;
    std::vector<hal::CanFrame> all;
    for (std::size_t count = some.size(); count == some.size();) {
      count = port.receive(until, some);
      all.insert(all.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
    }
    return all;
  }

  VirtualCanBus bus;
  std::unique_ptr<hal::CanBus> host;
  std::unique_ptr<hal::CanBus> base;
};

constexpr const char* kAny = "413#0102030405060708";

TEST(VirtualCanBus, AFrameArrivesAtTheOtherEndAfterItsWay) {
  Pair pair;
  ASSERT_TRUE(Pair::send(*pair.host, kAny, 1.0));
  EXPECT_TRUE(Pair::receive(*pair.base, at(1.0)).empty());
  const auto heard = Pair::receive(*pair.base, at(1.0) + kWire);
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(candump(heard[0]), kAny);
  EXPECT_EQ(heard[0].stamp, at(1.0) + kWire);
  EXPECT_TRUE(Pair::receive(*pair.host, at(2.0)).empty()) << "nobody hears himself";
}

TEST(VirtualCanBus, TheWireCarriesOneFrameAtATime) {
  Pair pair;
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(Pair::send(*pair.base, kAny, 1.0));
  const auto heard = Pair::receive(*pair.host, at(2.0));
  ASSERT_EQ(heard.size(), 10U);
  for (std::size_t i = 0; i < heard.size(); ++i) EXPECT_EQ(heard[i].stamp, at(1.0) + (i + 1) * kWire);
}

TEST(VirtualCanBus, APortMustBeStartedOnce) {
  VirtualCanBus bus;
  const auto port = bus.host();
  EXPECT_EQ(Pair::send(*port, kAny, 1.0).error(), CanSendFailure::kGone);
  EXPECT_EQ(port->state(), CanState::kGone);
  ASSERT_TRUE(port->start());
  EXPECT_EQ(port->state(), CanState::kActive);
  EXPECT_FALSE(port->start());
  port->stop();
  port->stop();
  EXPECT_TRUE(port->start());
}

TEST(VirtualCanBus, UnpluggedTheQueueFillsAndGoesOutLater) {
  Pair pair({{.trouble = BusTrouble::kUnplugged, .from = at(1.0), .to = at(2.0)}});
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(Pair::send(*pair.host, kAny, 1.0 + 0.01 * i));
  EXPECT_EQ(Pair::send(*pair.host, kAny, 1.2).error(), CanSendFailure::kQueueFull);
  EXPECT_EQ(pair.host->state(), CanState::kPassive);
  ASSERT_TRUE(Pair::send(*pair.base, kAny, 1.5));
  EXPECT_TRUE(Pair::receive(*pair.host, at(1.9)).empty());
  EXPECT_TRUE(Pair::receive(*pair.base, at(1.9)).empty());

  EXPECT_TRUE(Pair::receive(*pair.base, at(2.0)).empty());
  EXPECT_EQ(Pair::receive(*pair.base, at(2.0) + 10 * kWire).size(), 10U) << "old commands, all at once";
  EXPECT_TRUE(Pair::send(*pair.host, kAny, 2.1));
  EXPECT_EQ(pair.host->state(), CanState::kActive);
  EXPECT_EQ(pair.host->counters().error_passive, 1U);
  EXPECT_EQ(pair.host->counters().refused, 1U);
  EXPECT_EQ(pair.host->counters().sent, 11U);
}

TEST(VirtualCanBus, BusOffAndGoneAreWhatTheySay) {
  Pair pair({{.trouble = BusTrouble::kBusOff, .from = at(1.0), .to = at(2.0)},
             {.trouble = BusTrouble::kGone, .from = at(3.0), .to = at(4.0)}});
  EXPECT_EQ(Pair::send(*pair.host, kAny, 1.5).error(), CanSendFailure::kBusOff);
  EXPECT_EQ(pair.host->state(), CanState::kBusOff);
  ASSERT_TRUE(Pair::send(*pair.base, kAny, 1.6));
  EXPECT_TRUE(Pair::receive(*pair.host, at(2.5)).empty()) << "what was said meanwhile is lost";
  EXPECT_EQ(pair.host->state(), CanState::kActive);
  EXPECT_EQ(Pair::send(*pair.host, kAny, 3.5).error(), CanSendFailure::kGone);
  EXPECT_EQ(pair.host->state(), CanState::kGone);
  EXPECT_TRUE(Pair::send(*pair.host, kAny, 4.0));
  EXPECT_EQ(pair.host->counters().bus_off, 1U);
  EXPECT_EQ(pair.host->counters().restarts, 1U);
}

TEST(VirtualCanBus, ASecondCommanderIsHeardByBoth) {
  Pair pair({{.trouble = BusTrouble::kSecondCommander, .from = at(1.0), .to = at(1.1), .frame = frame(kAny)}});
  EXPECT_EQ(Pair::receive(*pair.base, at(2.0)).size(), 5U);
  EXPECT_EQ(Pair::receive(*pair.host, at(2.0)).size(), 5U);
}

TEST(VirtualCanBus, LosesOnlyWhatTheScriptSays) {
  Pair pair({{.trouble = BusTrouble::kIdLost, .from = at(1.0), .to = at(2.0), .frame = frame("401#")},
             {.trouble = BusTrouble::kBaseSilent, .from = at(3.0), .to = at(4.0)}});
  for (const double s : {0.5, 1.5, 2.5, 3.5, 4.5}) {
    ASSERT_TRUE(Pair::send(*pair.base, "401#0000000000000000", s));
    ASSERT_TRUE(Pair::send(*pair.base, "402#0000000000000000", s));
    ASSERT_TRUE(Pair::send(*pair.host, kAny, s));
  }
  EXPECT_EQ(Pair::receive(*pair.host, at(5.0)).size(), 2U + 1U + 2U + 0U + 2U);
  EXPECT_EQ(Pair::receive(*pair.base, at(5.0)).size(), 5U);
}

TEST(VirtualCanBus, WhoNeverListensLosesTheNewestAndIsTold) {
  Pair pair;
  for (int i = 0; i < 5000; ++i) ASSERT_TRUE(Pair::send(*pair.base, kAny, 1.0 + 0.001 * i));
  EXPECT_EQ(Pair::receive(*pair.host, at(10.0)).size(), 4096U);
  EXPECT_EQ(pair.host->counters().lost, 5000U - 4096U);
  EXPECT_EQ(pair.host->counters().received, 4096U);
}

TEST(VirtualCanBus, TheTapHearsTheWholeWire) {
  Pair pair({{.trouble = BusTrouble::kBaseSilent, .from = at(0.0)}});
  std::vector<std::string> wire;
  pair.bus.tap([&](const hal::CanFrame& f) { wire.push_back(candump(f)); });
  ASSERT_TRUE(Pair::send(*pair.host, kAny, 1.0));
  ASSERT_TRUE(Pair::send(*pair.base, "402#0000000000000000", 1.1));
  EXPECT_EQ(wire, (std::vector<std::string>{kAny, "402#0000000000000000"}));
}

}  // namespace
}  // namespace cgsr::sim
