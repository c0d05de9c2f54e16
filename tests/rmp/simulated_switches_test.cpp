#include "hal/sim/switches/simulated_switches.h"

#include <gtest/gtest.h>

#include "tests/rmp/rig.h"

namespace cgsr::sim {
namespace {

using test::at;

std::vector<SwitchLine> lines() {
  return {{"arm", true}, {"probe_lamp"}, {"face_light"}, {"room_lamp"}};
}

TEST(SimulatedSwitches, TheScriptPressesInputs) {
  SimulatedSwitches switches(lines(), {{SwitchHappening::kPressed, "arm", at(1.0), at(2.0)}});
  ASSERT_TRUE(switches.start());
  EXPECT_FALSE(*switches.read("arm"));
  switches.advance_to(at(1.0));
  EXPECT_TRUE(*switches.read("arm"));
  EXPECT_TRUE(switches.level("arm"));
  switches.advance_to(at(0.5));
  EXPECT_TRUE(*switches.read("arm")) << "time does not go back";
  switches.advance_to(at(2.0));
  EXPECT_FALSE(*switches.read("arm"));
}

TEST(SimulatedSwitchesFault, ALineThatDoesNotAnswerIsNamed) {
  SimulatedSwitches switches(lines(), {{SwitchHappening::kNoAnswer, "probe_lamp", at(1.0), at(2.0)}});
  ASSERT_TRUE(switches.start());
  ASSERT_TRUE(switches.set("probe_lamp", true));
  switches.advance_to(at(1.5));
  const auto set = switches.set("probe_lamp", false);
  ASSERT_FALSE(set);
  EXPECT_NE(set.error().message.find("probe_lamp"), std::string::npos);
  EXPECT_FALSE(switches.read("probe_lamp"));
  EXPECT_TRUE(switches.level("probe_lamp")) << "nothing has changed";
  EXPECT_TRUE(switches.set("face_light", true)) << "the others are well";
  switches.advance_to(at(2.0));
  EXPECT_TRUE(switches.set("probe_lamp", false));
  EXPECT_FALSE(switches.level("probe_lamp"));
}

TEST(SimulatedSwitchesFault, AStuckLineSaysThatAllIsWell) {
  SimulatedSwitches switches(lines(), {{SwitchHappening::kStuck, "room_lamp", at(0.0)}});
  switches.advance_to(at(0.0));
  ASSERT_TRUE(switches.start());
  EXPECT_TRUE(switches.set("room_lamp", true));
  EXPECT_TRUE(*switches.read("room_lamp"));
  EXPECT_FALSE(switches.level("room_lamp"));
}

TEST(SimulatedSwitchesFault, AScriptThatCannotHappenIsRefused) {
  const auto refusal = [](const SwitchEvent& event) {
    SimulatedSwitches switches(lines(), {event});
    const auto started = switches.start();
    return started ? std::string() : started.error().message;
  };
  EXPECT_NE(refusal({SwitchHappening::kPressed, "alarm"}).find("alarm"), std::string::npos);
  EXPECT_NE(refusal({SwitchHappening::kPressed, "room_lamp"}).find("room_lamp"), std::string::npos);
  EXPECT_NE(refusal({SwitchHappening::kStuck, "arm"}).find("arm"), std::string::npos);
  EXPECT_FALSE(SimulatedSwitches({{"twice"}, {"twice"}}).start());
  EXPECT_FALSE(SimulatedSwitches({{""}}).start());
}

}  // namespace
}  // namespace cgsr::sim
