// The simulated base by itself: does it move and talk like a Segway?

#include "hal/sim/base/simulated_rmp.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "hal/sim/base/virtual_segway.h"
#include "tests/rmp/frames.h"
#include "tests/rmp/rig.h"

namespace cgsr::sim {
namespace {

using test::at;
using test::candump;
using test::frame;
using test::kBegin;
using test::Random;

constexpr double kDegree = std::numbers::pi / 180.0;

/// A base, and somebody who talks to it in frames.
struct Bench {
  explicit Bench(const BaseParameters& parameters = {}, std::vector<BaseEvent> script = {}, std::uint64_t seed = 1,
                 BasePlacement placement = {.time = kBegin})
      : segway(parameters, {placement.time, placement.x_m, placement.y_m, placement.heading_rad, seed},
               std::move(script)),
        port(segway.host_port()) {
    EXPECT_TRUE(port->start());
  }

  void tell(const std::string& text) {
    auto f = frame(text);
    f.stamp = now;
    ASSERT_TRUE(port->send(f));
  }

  std::vector<hal::CanFrame> hear_until(double s) {
    now = at(s);
    std::vector<hal::CanFrame> heard;
    std::array<hal::CanFrame, 64> some;
    for (std::size_t count = some.size(); count == some.size();) {
      count = port->receive(now, some);
      heard.insert(heard.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
    }
    return heard;
  }

  /// Tells it the same every 20 ms until `s`. \return the states of every millisecond.
  std::vector<BaseState> drive_until(double s, const std::string& text) {
    std::vector<BaseState> states;
    while (now < at(s)) {
      tell(text);
      for (int i = 0; i < 20; ++i) states.push_back(segway.base().state_at(now += seconds(0.001)));
    }
    return states;
  }

  [[nodiscard]] BaseState state() { return segway.base().state_at(now); }

  VirtualSegway segway;
  std::unique_ptr<hal::CanBus> port;
  MonoTime now = kBegin;
};

std::string velocity(double mps) {
  return "413#" + fmt::format("{:04X}", static_cast<unsigned>(std::lround(mps * 332.0)) & 0xFFFFU) + "000000000000";
}
std::string turn(double degps) {
  return "413#0000" + fmt::format("{:04X}", static_cast<unsigned>(std::lround(degps * 7.8)) & 0xFFFFU) + "00000000";
}

TEST(SimulatedRmp, SendsItsSetAHundredTimesASecondInTheOrderOfARealBus) {
  Bench bench;
  const auto heard = bench.hear_until(1.0);
  std::map<int, int> count;
  for (const auto& f : heard) ++count[f.id];
  for (const int id : {0x400, 0x401, 0x402, 0x403, 0x404, 0x405, 0x406, 0x407, 0x680}) {
    EXPECT_GE(count[id], 99) << id;  // the last set is still on the wire
    EXPECT_LE(count[id], 100) << id;
  }
  std::string order;
  for (std::size_t i = 0; i < 9; ++i) order += fmt::format("{:03X} ", heard[i].id);
  EXPECT_EQ(order, "402 403 404 405 406 407 400 401 680 ");
  for (std::size_t i = 1; i < heard.size(); ++i) EXPECT_LT(heard[i - 1].stamp, heard[i].stamp);
  EXPECT_EQ(heard.front().stamp, at(0.010) + std::chrono::microseconds(222));
}

TEST(SimulatedRmp, LeansIntoItsAccelerationAndSettles) {
  BaseParameters parameters;
  parameters.max_acceleration_mps2 = 0.4;
  Bench bench(parameters);
  double most = 0.0, least = 0.0, min_x = 0.0;
  for (const auto& state : bench.drive_until(2.5, velocity(0.4))) {
    most = std::max(most, state.pitch_rad);
    min_x = std::min(min_x, state.x_m);
  }
  EXPECT_GT(most, 2.0 * kDegree);  // 0.4 / 9.81 is 2.3 degrees
  EXPECT_LT(most, 3.0 * kDegree);
  EXPECT_LT(min_x, 0.0) << "a balancing robot rolls back before it goes forward";
  EXPECT_GT(min_x, -0.01);
  EXPECT_NEAR(bench.state().pitch_rad, 0.0, 0.05 * kDegree);
  EXPECT_NEAR(bench.state().velocity.forward_mps, 0.4, 0.01);

  for (const auto& state : bench.drive_until(5.0, velocity(0.0))) least = std::min(least, state.pitch_rad);
  EXPECT_LT(least, -2.0 * kDegree) << "it leans back to brake";
  EXPECT_NEAR(bench.state().pitch_rad, 0.0, 0.05 * kDegree);
  EXPECT_NEAR(bench.state().velocity.forward_mps, 0.0, 0.005);
}

TEST(SimulatedRmp, DoesNotPitchAsATractor) {
  BaseParameters parameters;
  parameters.mode = BaseMode::kTractor;
  Bench bench(parameters);
  for (const auto& state : bench.drive_until(1.0, velocity(0.5))) ASSERT_EQ(state.pitch_rad, 0.0);
  EXPECT_NEAR(bench.state().velocity.forward_mps, 0.5, 0.02);
}

TEST(SimulatedRmp, SpeedNeverChangesFasterThanItsLimitAllowsATractor) {
  BaseParameters parameters;
  parameters.mode = BaseMode::kTractor;
  parameters.slip = 0.0;
  Bench bench(parameters);
  auto states = bench.drive_until(1.5, velocity(1.0));
  const auto back = bench.drive_until(3.5, velocity(-1.0));
  states.insert(states.end(), back.begin(), back.end());
  for (std::size_t i = 1; i < states.size(); ++i) {
    const double step = states[i].velocity.forward_mps - states[i - 1].velocity.forward_mps;
    ASSERT_LE(std::abs(step), parameters.max_acceleration_mps2 * 0.001 * 1.0001) << i;
  }
  EXPECT_NEAR(states.back().velocity.forward_mps, -1.0, 0.02);
}

TEST(SimulatedRmp, TurnsLeftForPositiveCounts) {
  Bench bench;
  bench.drive_until(2.0, turn(30.0));
  EXPECT_NEAR(bench.state().velocity.left_radps, 30.0 * kDegree, 0.02);
  EXPECT_GT(bench.state().heading_rad, 0.8);
}

TEST(SimulatedRmp, AboveTheKneeATurnCommandIsALateralAcceleration) {
  BaseParameters parameters;
  parameters.slip = parameters.turn_scrub = 0.0;
  Bench bench(parameters);
  bench.drive_until(4.0, "413#" + fmt::format("{:04X}", 1042) + "00EA00000000");  // 3.14 m/s and 30 deg/s
  EXPECT_NEAR(bench.state().velocity.left_radps, 15.0 * kDegree, 0.5 * kDegree);
}

TEST(SimulatedRmp, WithoutACommandItSlewsToZeroAfterFourTenths) {
  Bench bench;
  bench.drive_until(2.0, velocity(0.5));  // the last one at 1.98
  EXPECT_NEAR(bench.segway.base().state_at(at(2.38)).velocity.forward_mps, 0.5, 0.01);
  EXPECT_LT(bench.segway.base().state_at(at(2.70)).velocity.forward_mps, 0.45);  // it leans back first
  EXPECT_NEAR(bench.segway.base().state_at(at(3.60)).velocity.forward_mps, 0.0, 0.01);
}

TEST(SimulatedRmp, StatusFollowsTheScript) {
  Bench bench(
      {}, {{.trouble = BaseTrouble::kEmergencyStop, .from = at(1.0), .to = at(2.0)},
           {.trouble = BaseTrouble::kLowBattery, .from = at(3.0), .to = at(4.0)},
           {.trouble = BaseTrouble::kStatusBits, .from = at(5.0), .to = at(6.0), .word1 = 0x0010, .word2 = 0x0800}});
  const auto status = [&](double s) {
    std::string last;
    for (const auto& f : bench.hear_until(s)) {
      if (f.id == 0x680) last = candump(f);
    }
    return last;
  };
  EXPECT_EQ(status(0.5), "680#0005018000000000");
  EXPECT_EQ(status(1.5), "680#0005000000020000");
  EXPECT_EQ(status(2.5), "680#0005018000000000");
  EXPECT_EQ(status(3.5), "680#0005418000000000");
  EXPECT_EQ(status(5.5), "680#0005019008000000");
}

TEST(SimulatedRmp, AnEmergencyStopBrakesWhateverIsCommanded) {
  Bench bench({}, {{.trouble = BaseTrouble::kEmergencyStop, .from = at(2.0)}});
  bench.drive_until(2.0, velocity(0.8));
  bench.drive_until(2.5, velocity(0.8));
  EXPECT_NEAR(bench.state().velocity.forward_mps, 0.0, 1e-9);
}

TEST(SimulatedRmp, SwitchedOffItOnlySaysSo) {
  Bench bench({}, {{.trouble = BaseTrouble::kPowerOff, .from = at(1.0), .to = at(3.0)}});
  (void)bench.hear_until(1.005);
  for (const auto& f : bench.hear_until(2.99)) EXPECT_EQ(f.id, 0x412);
  const auto again = bench.hear_until(3.02);
  ASSERT_FALSE(again.empty());
  EXPECT_EQ(candump(again.front()), "402#0000000000000001") << "its servo frames begin anew";
  EXPECT_EQ(candump(again[2]), "404#0000000000000000");
}

TEST(SimulatedRmp, AHostCanTakeThePowerAway) {
  Bench bench;
  bench.drive_until(1.0, velocity(0.5));
  bench.tell("412#0000000000000000");
  (void)bench.hear_until(1.02);
  for (const auto& f : bench.hear_until(2.0)) EXPECT_EQ(f.id, 0x412);
  EXPECT_NEAR(bench.state().velocity.forward_mps, 0.0, 1e-9);
}

TEST(SimulatedRmp, ObeysItsConfiguration) {
  Bench bench;
  const auto heard = [&](double s, int id) {
    hal::CanFrame last;
    for (const auto& f : bench.hear_until(s)) {
      if (f.id == id) last = f;
    }
    return candump(last);
  };
  EXPECT_EQ(heard(0.1, 0x406), "406#00020000018A0130");
  bench.tell("413#00000000000D0002");  // gain schedule
  bench.tell("413#000000000032000F");  // integrators
  EXPECT_EQ(heard(0.2, 0x406), "406#00020002018A0130");
  EXPECT_EQ(heard(0.3, 0x404), "404#0000000000000000");
  bench.tell("413#0000000000100101");  // tractor, the parameter in both bytes as some hosts write it
  EXPECT_EQ(heard(0.4, 0x680), "680#0005008000000000");
  bench.tell("413#00000000000F0001");  // no balancing
  bench.tell("413#0000000000100002");  // balance: refused
  EXPECT_EQ(heard(0.5, 0x406), "406#00010002018A0130");
  bench.tell("413#0000000000100000");  // disabled
  EXPECT_EQ(heard(0.6, 0x680), "680#0005000000000000");
  bench.tell("413#00A600EA00000000");
  EXPECT_EQ(heard(0.7, 0x407), "407#00A600EA00000000") << "it echoes what it does not obey";
  EXPECT_EQ(bench.state().velocity.forward_mps, 0.0);
}

TEST(SimulatedRmp, ScalesOfVelocityAndTurnAreSixteenths) {
  Bench bench;
  bench.tell("413#00000000000A0008");
  bench.tell("413#00000000000C0004");
  bench.drive_until(2.0, "413#014C00EA00000000");  // 1 m/s, 30 deg/s
  EXPECT_NEAR(bench.state().velocity.forward_mps, 0.5, 0.02);
  EXPECT_NEAR(bench.state().velocity.left_radps, 7.5 * kDegree, 0.01);
}

TEST(SimulatedRmp, BeginsWhereItIsPut) {
  Bench bench({}, {}, 1, {.time = kBegin, .x_m = 3.0, .y_m = -2.0, .heading_rad = 0.5 * std::numbers::pi});
  EXPECT_EQ(bench.state().x_m, 3.0);
  bench.drive_until(4.0, velocity(0.5));
  EXPECT_NEAR(bench.state().x_m, 3.0, 0.05);
  EXPECT_GT(bench.state().y_m, -0.5);
}

TEST(SimulatedRmp, SlipMakesOdometryDrift) {
  BaseParameters clean;
  clean.slip = clean.turn_scrub = 0.0;
  const auto off_by = [](const BaseParameters& parameters, std::uint64_t seed) {
    Bench bench(parameters, {}, seed);
    bench.drive_until(10.0, velocity(0.5));
    return bench.state().heading_rad;
  };
  EXPECT_EQ(off_by(clean, 1), 0.0);
  const double one = off_by({}, 1), other = off_by({}, 2);
  EXPECT_NE(one, other);
  EXPECT_GT(std::max(std::abs(one), std::abs(other)), 0.002);
  EXPECT_LT(std::max(std::abs(one), std::abs(other)), 0.2);
}

// Whoever asks how often: only what was sent when counts.
TEST(SimulatedRmpProperty, HowOftenItIsAskedDoesNotMatter) {
  Random random(7);
  for (int trial = 0; trial < 20; ++trial) {
    Bench steady, restless;
    std::string one, other;
    for (int cycle = 1; cycle <= 200; ++cycle) {
      const std::string order = velocity(random.real(-1.0, 1.0));
      steady.tell(order);
      restless.tell(order);
      for (auto asked = random.whole(0, 5); asked > 0; --asked) {
        const MonoTime early = kBegin + seconds(0.010 * (cycle - 1)) + Duration{random.whole(0, 9'999'999)};
        (void)restless.segway.base().state_at(early);
      }
      for (const auto& f : steady.hear_until(0.010 * cycle)) one += candump(f);
      for (const auto& f : restless.hear_until(0.010 * cycle)) other += candump(f);
    }
    ASSERT_EQ(one, other);
    const auto a = steady.state(), b = restless.state();
    ASSERT_EQ(a.x_m, b.x_m);
    ASSERT_EQ(a.heading_rad, b.heading_rad);
    ASSERT_EQ(a.pitch_rad, b.pitch_rad);
  }
}

TEST(SimulatedRmp, RemembersTheLastSecond) {
  Bench bench;
  const auto then = bench.drive_until(2.0, velocity(0.5));
  bench.drive_until(2.8, velocity(0.0));
  for (std::size_t i = 1800; i < then.size(); i += 17) {
    const auto now = bench.segway.base().state_at(then[i].stamp);
    ASSERT_EQ(now.stamp, then[i].stamp);
    ASSERT_NEAR(now.x_m, then[i].x_m, 1e-12);
    ASSERT_NEAR(now.pitch_rad, then[i].pitch_rad, 1e-12);
  }
  const auto long_ago = bench.segway.base().state_at(at(0.1));
  EXPECT_NEAR(to_seconds(long_ago.stamp - at(1.777)), 0.0, 0.0021) << "the oldest that is";
}

// Between the points of the grid the truth is smooth, also past the newest one.
TEST(SimulatedRmp, TheTruthIsSmoothWithinAMillisecond) {
  Bench bench;
  bench.drive_until(1.0, velocity(0.8));
  double last = bench.state().x_m;
  for (int i = 0; i < 3000; ++i) {
    const double x = bench.segway.base().state_at(bench.now += std::chrono::microseconds(10)).x_m;
    ASSERT_GT(x, last) << i;
    ASSERT_LT(x - last, 2.0e-5) << i;
    last = x;
  }
}

// A camera's thread asks for the truth while the motion thread drives: nothing tears (for ThreadSanitizer), and the
// truth at a stamp is the same for whoever asks.
TEST(VirtualSegwayStress, TheTruthMayBeAskedForFromAnotherThread) {
  test::Rig rig;
  std::atomic<bool> done{false};
  std::atomic<std::int64_t> driven_to_ns{kBegin.time_since_epoch().count()};
  std::atomic<int> compared{0};
  std::thread camera([&] {
    while (!done.load()) {
      const MonoTime time{Duration{driven_to_ns.load()}};
      const BaseState a = rig.segway.base().state_at(time);
      const BaseState b = rig.segway.base().state_at(time);
      if (a.stamp != time || b.stamp != time) continue;  // more than a second ago by now, and forgotten
      ASSERT_NEAR(a.x_m, b.x_m, 1e-12);
      ++compared;
    }
  });
  for (int cycle = 0; cycle < 3000; ++cycle) {
    (void)rig.cycle({.forward_mps = 0.3});
    driven_to_ns.store(rig.now.time_since_epoch().count());
    if (cycle % 50 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  done.store(true);
  camera.join();
  EXPECT_GT(compared.load(), 0);
  EXPECT_GT(rig.odometry.x_m, 8.0);
}

TEST(SegwayBody, ADirectionTurnsLikeSineAndCosine) {
  for (const double angle : {0.0, 1e-6, 0.01, -0.5, 1.0, -2.0, 3.0, 10.0}) {
    Direction direction;
    direction.turn(angle);
    EXPECT_NEAR(direction.x, std::cos(angle), 1e-13) << angle;
    EXPECT_NEAR(direction.y, std::sin(angle), 1e-13) << angle;
  }
  Direction direction;
  for (int i = 0; i < 1000000; ++i) direction.turn(0.002);
  EXPECT_NEAR(std::hypot(direction.x, direction.y), 1.0, 1e-14);
  EXPECT_NEAR(direction.x, std::cos(2000.0), 1e-9);
}

TEST(SegwayBody, NoiseHasMeanZeroAndDeviationOne) {
  Noise noise(5);
  double sum = 0.0, squares = 0.0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double n = noise.next();
    sum += n;
    squares += n * n;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.02);
  EXPECT_NEAR(squares / kCount, 1.0, 0.02);
}

}  // namespace
}  // namespace cgsr::sim
