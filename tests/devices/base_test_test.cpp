// `cgsr devices base --test` with the simulated Segway on its bus.
#include "src/devices/base_test.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/sim/base/virtual_segway.h"

namespace cgsr::devices {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// Whoever sleeps on it moves it.
class SteppingClock final : public Clock {
 public:
  [[nodiscard]] MonoTime now() const override { return now_; }
  void sleep_until(MonoTime wake_up_at) override { now_ = std::max(now_, wake_up_at); }

 private:
  MonoTime now_{seconds(100.0)};
};

struct Bench {
  explicit Bench(const std::vector<sim::BusEvent>& bus = {}, const std::vector<sim::BaseEvent>& base = {},
                 const hal::rmp::RmpParameters& own = {})
      : parameters(own), segway({}, {.time = clock.now(), .seed = 1}, base, bus), drive(segway.host_port(), own) {
    segway.bus().tap([this](const hal::CanFrame& frame) { commands += frame.id == 0x413 ? 1 : 0; });
  }

  Result<void> test(const BaseTestOptions& options, bool confirms = false) {
    return test_base(drive, parameters, clock, options,
                     {[this](const std::string& line) { lines.push_back(line); },
                      [this, confirms] {
                        ++asked;
                        clock.sleep_until(clock.now() + thinks);
                        return confirms;
                      }});
  }

  hal::rmp::RmpParameters parameters;
  SteppingClock clock;
  sim::VirtualSegway segway;
  hal::rmp::RmpDrive drive;
  std::vector<std::string> lines;
  int commands = 0;
  int asked = 0;
  Duration thinks{};  ///< whoever is asked.
};

TEST(BaseTest, ListensShowsOdometryAndStatusAndSendsNothing) {
  Bench bench;
  const auto passed = bench.test({});
  EXPECT_TRUE(passed) << passed.error().message;
  EXPECT_EQ(bench.commands, 0);
  EXPECT_EQ(bench.asked, 0);
  EXPECT_GE(bench.lines.size(), 10U);
  EXPECT_THAT(bench.lines,
              Contains(testing::AllOf(HasSubstr("battery 7"), HasSubstr("mode balance"), HasSubstr("fault: none"))));
  EXPECT_THAT(bench.lines.back(), HasSubstr("0 lost"));
}

TEST(BaseTest, WithoutAConfirmationItDoesNotMove) {
  Bench bench;
  EXPECT_TRUE(bench.test({.arm = true}, false));
  EXPECT_EQ(bench.asked, 1);
  EXPECT_EQ(bench.commands, 0);
}

TEST(BaseTest, ConfirmedItMovesALittleForwardAndLeftAndStands) {
  Bench bench;
  const auto passed = bench.test({.arm = true}, true);
  EXPECT_TRUE(passed) << passed.error().message;
  EXPECT_GT(bench.commands, 100);
  EXPECT_THAT(bench.lines.back(), testing::AllOf(HasSubstr("forward: +0."), HasSubstr("left: +")));
  EXPECT_NEAR(bench.segway.base().state_at(bench.clock.now()).velocity.forward_mps, 0.0, 0.05);
}

// Nobody reads the bus meanwhile.
TEST(BaseTest, WhoeverConfirmsMayTakeHisTime) {
  Bench bench;
  bench.thinks = seconds(20.0);
  const auto passed = bench.test({.arm = true}, true);
  EXPECT_TRUE(passed) << passed.error().message;
  EXPECT_THAT(bench.lines.back(), HasSubstr("forward: +0."));
}

TEST(BaseTest, ASilentBaseAndOneThatCannotMoveAreNamed) {
  Bench silent({{.trouble = sim::BusTrouble::kBaseSilent}});
  const auto nothing = silent.test({});
  ASSERT_FALSE(nothing);
  EXPECT_THAT(nothing.error().message, HasSubstr("nothing complete was heard"));
  Bench stopped({}, {{.trouble = sim::BaseTrouble::kEmergencyStop}});
  const auto refused = stopped.test({.arm = true}, true);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("the emergency stop is open"));
  EXPECT_EQ(stopped.asked, 0);
  EXPECT_EQ(stopped.commands, 0);
}

}  // namespace
}  // namespace cgsr::devices
