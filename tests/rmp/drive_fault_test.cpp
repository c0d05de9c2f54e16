// What the driver does when something goes wrong: how soon it is noticed, what the wheels do, and what ends it.

#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/rmp/rmp_drive.h"
#include "hal/sim/base/wire.h"
#include "tests/rmp/frames.h"
#include "tests/rmp/rig.h"

namespace cgsr {
namespace {

using hal::DriveFailure;
using hal::DriveFault;
using sim::BaseTrouble;
using sim::BusTrouble;
using test::at;
using test::frame;
using test::kForward;
using test::kStand;
using test::Rig;

struct Case {
  std::string name;
  Rig::Setup setup{};  // the trouble lasts from 2.005 s to 4.005 s
  DriveFault fault = DriveFault::kNone;
  DriveFailure failure = DriveFailure::kNotReady;
  double noticed_within_s = 0.0;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

constexpr double kFrom_s = 2.005, kTo_s = 4.005;

Case base_case(std::string name, sim::BaseEvent event, DriveFault fault, double within_s = 0.03) {
  event.from = at(kFrom_s);
  event.to = at(kTo_s);
  Case c{.name = std::move(name), .fault = fault, .noticed_within_s = within_s};
  c.setup.base_script = {event};
  return c;
}

Case bus_case(std::string name, BusTrouble trouble, DriveFault fault, DriveFailure failure, double within_s,
              const std::string& of_frame = "413#0000000000000000") {
  Case c{.name = std::move(name), .fault = fault, .failure = failure, .noticed_within_s = within_s};
  c.setup.bus_script = {{.trouble = trouble, .from = at(kFrom_s), .to = at(kTo_s), .frame = frame(of_frame)}};
  return c;
}

std::vector<Case> cases() {
  std::vector<Case> all = {
      base_case("EmergencyStop", {.trouble = BaseTrouble::kEmergencyStop}, DriveFault::kEmergencyStop),
      base_case("LowBattery", {.trouble = BaseTrouble::kLowBattery}, DriveFault::kLowBattery),
      base_case("SafetyShutdown", {.trouble = BaseTrouble::kSafetyShutdown}, DriveFault::kSafetyShutdown),
      base_case("MotorsOff", {.trouble = BaseTrouble::kMotorsOff}, DriveFault::kMotorsOff),
      base_case("PitchLimit", {.trouble = BaseTrouble::kStatusBits, .word2 = 0x0100}, DriveFault::kBaseFault),
      base_case("PoweredOff", {.trouble = BaseTrouble::kPowerOff}, DriveFault::kPoweredOff, 0.26),
      bus_case("BaseSilent", BusTrouble::kBaseSilent, DriveFault::kFeedbackLost, DriveFailure::kNoFeedback, 0.12),
      bus_case("Unplugged", BusTrouble::kUnplugged, DriveFault::kLinkLost, DriveFailure::kSendFailed, 0.14),
      bus_case("BusOff", BusTrouble::kBusOff, DriveFault::kBusOff, DriveFailure::kSendFailed, 0.02),
      bus_case("Gone", BusTrouble::kGone, DriveFault::kLinkLost, DriveFailure::kSendFailed, 0.02),
      bus_case("SecondCommander", BusTrouble::kSecondCommander, DriveFault::kSecondCommander, DriveFailure::kNotReady,
               0.02),
  };
  for (const char* needed : {"401", "402", "404", "406", "680"}) {
    all.push_back(bus_case(std::string("Lost") + needed, BusTrouble::kIdLost, DriveFault::kFeedbackLost,
                           DriveFailure::kNoFeedback, 0.13, std::string(needed) + "#"));
  }
  return all;
}

class RmpDriveEveryFault : public testing::TestWithParam<Case> {};

// Run, trouble, trouble over, too early to re-arm, re-armed: the whole life of a fault.
TEST_P(RmpDriveEveryFault, StopsLatchesAndIsRearmed) {
  Rig rig(GetParam().setup);
  ASSERT_TRUE(rig.run_until(2.0, kForward));

  const auto noticed = rig.run_until_fault(GetParam().fault, kForward);
  ASSERT_TRUE(noticed);
  EXPECT_LE(*noticed, GetParam().noticed_within_s);

  const auto during = rig.run_until(3.5, kForward);
  ASSERT_FALSE(during);
  EXPECT_EQ(during.error(), GetParam().failure);
  EXPECT_EQ(rig.drive.fault(), GetParam().fault);
  EXPECT_EQ(rig.drive.rearm(rig.now).error(), GetParam().fault) << "not while it lasts";
  EXPECT_NEAR(rig.true_speed_mps(), 0.0, 0.01);
  if (GetParam().failure == DriveFailure::kNoFeedback) {
    const auto heard = rig.drive.odometry(rig.now);
    ASSERT_FALSE(heard) << "old odometry is none";
    EXPECT_EQ(heard.error(), DriveFailure::kNoFeedback);
  }
  const double where_m = rig.segway.base().state_at(rig.now).x_m;

  // Over, but nobody has re-armed: zero may be commanded and nothing else.
  (void)rig.run_until(5.5, kForward);
  EXPECT_EQ(rig.drive.fault(), GetParam().fault) << "the first cause stays until it is re-armed";
  EXPECT_EQ(rig.cycle(kForward).error(), DriveFailure::kNotReady);
  EXPECT_TRUE(rig.cycle(kStand));
  EXPECT_NEAR(rig.segway.base().state_at(rig.now).x_m, where_m, 0.02);

  ASSERT_TRUE(rig.drive.rearm(rig.now));
  EXPECT_EQ(rig.drive.fault(), DriveFault::kNone);
  EXPECT_TRUE(rig.run_until(8.0, kForward));
  EXPECT_NEAR(rig.true_speed_mps(), 0.4, 0.02);
}

INSTANTIATE_TEST_SUITE_P(All, RmpDriveEveryFault, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<Case>& c) { return c.param.name; });

TEST(RmpDriveFault, WhatIsNotNeededMayBeMissing) {
  Rig::Setup setup;
  for (const char* id : {"400#", "403#", "405#", "407#", "414#", "688#"}) {
    setup.bus_script.push_back({.trouble = BusTrouble::kIdLost, .from = at(1.0), .frame = frame(id)});
  }
  Rig rig(setup);
  EXPECT_TRUE(rig.run_until(3.0, kForward));
  EXPECT_EQ(rig.drive.fault(), DriveFault::kNone);
}

TEST(RmpDriveFault, TheMissingMessageIsNamed) {
  Rig::Setup setup;
  setup.bus_script = {{.trouble = BusTrouble::kIdLost, .from = at(1.005), .frame = frame("406#")}};
  Rig rig(setup);
  (void)rig.run_until(2.0, kForward);
  const auto oldest = rig.drive.oldest_feedback(rig.now);
  ASSERT_TRUE(oldest);
  EXPECT_EQ(oldest->id, hal::rmp::MessageId::kModeAndPower);
  EXPECT_NEAR(to_seconds(oldest->age), 1.0, 0.011);
}

TEST(RmpDriveFault, RearmingWaitsForWholeSetsInARow) {
  Rig::Setup setup;
  setup.base_script = {{.trouble = BaseTrouble::kEmergencyStop, .from = at(1.0), .to = at(2.0)}};
  Rig rig(setup);
  (void)rig.run_until(2.05, kStand);
  EXPECT_EQ(rig.drive.fault(), DriveFault::kStarting);
  EXPECT_EQ(rig.drive.rearm(rig.now).error(), DriveFault::kStarting);
  (void)rig.run_until(2.12, kStand);
  EXPECT_TRUE(rig.drive.rearm(rig.now));
}

// The person who re-arms does not set off what was commanded before.
TEST(RmpDriveFault, RearmingForgetsTheOldCommand) {
  Rig::Setup setup;
  setup.base_script = {{.trouble = BaseTrouble::kEmergencyStop, .from = at(1.0), .to = at(2.0)}};
  Rig rig(setup);
  (void)rig.run_until(3.0, kForward);
  ASSERT_TRUE(rig.drive.rearm(rig.now));
  const double x_m = rig.segway.base().state_at(rig.now).x_m;
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(rig.drive.odometry(rig.now += seconds(0.010)));
  EXPECT_NEAR(rig.segway.base().state_at(rig.now).x_m, x_m, 1e-4);
}

TEST(RmpDriveFault, ABaseThatWakesUpLateIsWaitedFor) {
  Rig::Setup setup;
  setup.base_script = {{.trouble = BaseTrouble::kPowerOff, .from = at(0.0), .to = at(2.0)}};
  Rig rig(setup);
  (void)rig.run_until(1.5, kForward);
  EXPECT_EQ(rig.drive.fault(), DriveFault::kPoweredOff);
  EXPECT_TRUE(rig.run_until(3.5, kForward)) << "it was never ready before: nothing to re-arm";
  EXPECT_EQ(rig.drive.fault(), DriveFault::kNone);
}

TEST(RmpDriveFault, AnEmergencyStopLatchesFromTheBeginning) {
  Rig::Setup setup;
  setup.base_script = {{.trouble = BaseTrouble::kEmergencyStop, .from = at(0.0), .to = at(1.0)}};
  Rig rig(setup);
  EXPECT_EQ(rig.run_until(3.0, kForward).error(), DriveFailure::kNotReady);
  EXPECT_EQ(rig.drive.fault(), DriveFault::kEmergencyStop);
}

// Integrators of a base that was switched off begin at zero again; the pose does not.
TEST(RmpDriveFault, ThePoseSurvivesARestartOfTheBase) {
  Rig::Setup setup;
  setup.base_script = {{.trouble = BaseTrouble::kPowerOff, .from = at(4.0), .to = at(7.0)}};
  setup.base.slip = 0.0;
  Rig rig(setup);
  (void)rig.run_until(3.99, kForward);
  const double before_m = rig.odometry.x_m;
  ASSERT_GT(before_m, 1.0);
  (void)rig.run_until(8.5, kStand);
  EXPECT_EQ(rig.drive.counters().feedback.new_baselines, 1U);
  EXPECT_NEAR(rig.odometry.x_m, before_m, 0.005);
  ASSERT_TRUE(rig.drive.rearm(rig.now));
  ASSERT_TRUE(rig.run_until(9.5, kForward));
  EXPECT_GT(rig.odometry.x_m, before_m + 0.1);
}

TEST(RmpDriveFault, AFewLostSetsAreCountedAndNothingElse) {
  Rig::Setup setup;
  setup.bus_script = {{.trouble = BusTrouble::kBaseSilent, .from = at(2.005), .to = at(2.055)}};
  setup.base.slip = 0.0;
  Rig rig(setup);
  EXPECT_TRUE(rig.run_until(3.0, kForward));
  EXPECT_EQ(rig.drive.counters().feedback.lost_sets, 5U);
  EXPECT_EQ(rig.drive.counters().feedback.late, 1U);
  EXPECT_EQ(rig.drive.counters().feedback.stale, 0U);
  EXPECT_NEAR(rig.odometry.x_m, rig.segway.base().state_at(rig.odometry.stamp).x_m, 0.005)
      << "the way over the gap is not lost";
}

TEST(RmpDriveFault, OneRefusedCommandIsNoLostLink) {
  Rig::Setup setup;
  // The queue takes ten frames; the eleventh and the twelfth are refused, then the cable is back.
  setup.bus_script = {{.trouble = BusTrouble::kUnplugged, .from = at(2.005), .to = at(2.095)}};
  setup.drive.feedback_timeout_s = 0.3;
  setup.drive.max_refusals = 3;
  Rig rig(setup);
  EXPECT_TRUE(rig.run_until(3.0, kForward));
  EXPECT_EQ(rig.drive.fault(), DriveFault::kNone);
}

TEST(RmpDriveFault, TheEchoTellsOfCommandsThatOthersGave) {
  Rig::Setup setup;
  setup.bus_script = {{.trouble = BusTrouble::kSecondCommander,
                       .from = at(2.005),
                       .to = at(2.505),
                       .frame = frame("413#0011002200000000")}};
  Rig rig(setup);
  (void)rig.run_until(2.0, kForward);
  EXPECT_EQ(rig.drive.counters().feedback.echo_mismatches, 0U);
  (void)rig.run_until(3.0, kForward);
  EXPECT_GT(rig.drive.counters().feedback.echo_mismatches, 10U);
  EXPECT_EQ(rig.drive.counters().feedback.foreign_commands, 25U);
}

TEST(RmpDriveFault, ImplausibleValuesAreLeftOut) {
  Rig rig;
  (void)rig.run_until(1.0, kForward);
  const auto before = rig.odometry;
  for (const char* damaged : {"402#5A5A5A5A5A5A0064", "401#5A5A000000000000", "404#5A5A5A5A5A5A5A5A"}) {
    auto f = frame(damaged);
    f.stamp = rig.now;
    rig.segway.bus().inject(f);
  }
  EXPECT_TRUE(rig.cycle(kForward));
  EXPECT_NEAR(rig.odometry.velocity.forward_mps, before.velocity.forward_mps, 0.05);
  EXPECT_NEAR(rig.odometry.pitch_rad, before.pitch_rad, 0.05);
  EXPECT_NEAR(rig.odometry.x_m, before.x_m, 0.02);
  EXPECT_EQ(rig.drive.counters().feedback.implausible, 2U);
  EXPECT_EQ(rig.drive.counters().feedback.jumps, 1U);
}

// A message that comes but is never believed is a message that does not come.
TEST(RmpDriveFault, DisplacementsThatOnlyJumpAreLostFeedback) {
  Rig::Setup setup;
  setup.bus_script = {{.trouble = BusTrouble::kIdLost, .from = at(1.005), .frame = frame("404#")}};
  Rig rig(setup);
  ASSERT_TRUE(rig.run_until(1.0, kForward));
  test::Random random(4);
  while (rig.now < at(1.2)) {
    (void)rig.cycle(kForward);
    auto f = sim::integrated_frame(static_cast<std::uint32_t>(random.whole(0, 0xFFFFFFFF)), 0);
    f.stamp = rig.now;
    f.id = 0x404;
    rig.segway.bus().inject(f);
  }
  EXPECT_EQ(rig.drive.fault(), DriveFault::kFeedbackLost);
  EXPECT_GT(rig.drive.counters().feedback.jumps, 10U);
}

TEST(RmpDriveFault, EveryFaultHasItsWords) {
  for (int i = 0; i <= static_cast<int>(DriveFault::kMotorsOff); ++i) {
    EXPECT_FALSE(to_string(static_cast<DriveFault>(i)).empty());
    for (int j = 0; j < i; ++j) EXPECT_NE(to_string(static_cast<DriveFault>(i)), to_string(static_cast<DriveFault>(j)));
  }
}

}  // namespace
}  // namespace cgsr
