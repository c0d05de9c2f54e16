#include "hal/rmp/odometer.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/rmp/frames.h"

namespace cgsr::hal::rmp {
namespace {

using Outcome = Odometer::Outcome;
using test::Random;

const RmpScales kScales;

Odometer odometer() {
  return {kScales, 5.0, 8.0};
}

std::uint32_t metres(double m) {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::lround(m * 33215.0)));
}
std::uint32_t turns(double rad) {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::lround(rad / (2.0 * std::numbers::pi) * 112644.0)));
}

TEST(Odometer, BeginsAtZeroWhateverTheCounts) {
  auto o = odometer();
  EXPECT_EQ(o.take({0xDEADBEEF, 0x12345678}, 77), Outcome::kBaseline);
  EXPECT_EQ(o.pose().x_m, 0.0);
  EXPECT_EQ(o.pose().y_m, 0.0);
  EXPECT_EQ(o.pose().heading_rad, 0.0);
}

// A quarter of a circle to the left with radius 1 m ends at (1, 1), looking along y.
TEST(Odometer, AQuarterCircle) {
  auto o = odometer();
  constexpr int kSteps = 200;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / kSteps;
    o.take({metres(angle), turns(angle)}, static_cast<std::uint16_t>(i));
  }
  EXPECT_NEAR(o.pose().x_m, 1.0, 1e-3);
  EXPECT_NEAR(o.pose().y_m, 1.0, 1e-3);
  EXPECT_NEAR(o.pose().heading_rad, 0.5 * std::numbers::pi, 1e-4);
}

// Wherever the counters of way, angle and servo frames begin, and however they wrap, the pose is the same.
TEST(OdometerProperty, TheStartOfTheCountersDoesNotMatter) {
  Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    auto plain = odometer();
    auto moved = odometer();
    // Close below a wrap as often as anywhere.
    const auto near_wrap = [&] { return static_cast<std::uint32_t>(-random.whole(0, 40000)); };
    const auto anywhere = [&] { return static_cast<std::uint32_t>(random.whole(0, 0xFFFFFFFF)); };
    const std::uint32_t s0 = trial % 2 == 0 ? near_wrap() : anywhere();
    const std::uint32_t a0 = trial % 3 == 0 ? near_wrap() : anywhere();
    const auto f0 = static_cast<std::uint16_t>(random.whole(65000, 65535));
    std::uint32_t s = 0, a = 0;
    std::uint16_t f = 0;
    for (int i = 0; i < 600; ++i) {
      ASSERT_NE(plain.take({s, a}, f), Outcome::kJump);
      ASSERT_NE(moved.take({s0 + s, a0 + a}, static_cast<std::uint16_t>(f0 + f)), Outcome::kJump);
      s += static_cast<std::uint32_t>(random.whole(-600, 900));
      a += static_cast<std::uint32_t>(random.whole(-400, 500));
      f = static_cast<std::uint16_t>(f + random.whole(1, 3));
    }
    ASSERT_EQ(plain.pose().x_m, moved.pose().x_m) << trial;
    ASSERT_EQ(plain.pose().y_m, moved.pose().y_m) << trial;
    ASSERT_EQ(plain.pose().heading_rad, moved.pose().heading_rad) << trial;
  }
}

TEST(Odometer, ADamagedValueCostsNothing) {
  auto o = odometer();
  for (std::uint16_t i = 0; i < 10; ++i) o.take({metres(0.005 * i), 0}, i);
  EXPECT_EQ(o.take({0x5A5A5A5A, 0x5A5A5A5A}, 10), Outcome::kJump);
  EXPECT_EQ(o.take({metres(0.055), 0}, 11), Outcome::kTravelled);
  EXPECT_NEAR(o.pose().x_m, 0.055, 1e-4);
}

TEST(Odometer, AResetOfTheBaseKeepsThePose) {
  auto o = odometer();
  o.take({metres(100.0), turns(50.0)}, 5000);
  o.take({metres(100.02), turns(50.0)}, 5001);
  EXPECT_EQ(o.take({0, 0}, 1), Outcome::kJump);
  EXPECT_EQ(o.take({metres(0.01), 0}, 2), Outcome::kNewBaseline);
  EXPECT_EQ(o.take({metres(0.02), 0}, 3), Outcome::kTravelled);
  EXPECT_NEAR(o.pose().x_m, 0.02 + 0.01, 1e-3);
}

TEST(Odometer, LostSetsAreBridgedForASecond) {
  auto o = odometer();
  o.take({0, 0}, 0);
  EXPECT_EQ(o.take({metres(0.4), 0}, 100), Outcome::kTravelled);
  EXPECT_EQ(o.take({metres(0.8), 0}, 201), Outcome::kJump) << "after more than a second the counters may be others";
}

TEST(Odometer, NoBaseIsThatFast) {
  auto o = odometer();
  o.take({0, 0}, 0);
  EXPECT_EQ(o.take({metres(0.11), 0}, 1), Outcome::kJump);
  EXPECT_EQ(o.take({0, turns(0.2)}, 1), Outcome::kJump);
  EXPECT_EQ(o.take({metres(0.04), turns(0.1)}, 1), Outcome::kTravelled);
}

}  // namespace
}  // namespace cgsr::hal::rmp
