// What a scenario file may say, and what it may not.
#include "hal/sim/home/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/home/rig.h"

namespace cgsr::sim {
namespace {

using test::ScenarioFile;
using ::testing::HasSubstr;

std::string refusal(const std::string& text) {
  const ScenarioFile file(text);
  const auto home = SimulatedHome::make(test::small(file));
  return home ? "" : home.error().message;
}

TEST(Scenario, NamesWhatTheWorldDoesNotHave) {
  EXPECT_THAT(refusal("[[actor]]\nname = \"ghost\"\n"), HasSubstr("actor 'ghost': the world has nobody of that name"));
  EXPECT_THAT(refusal("[[light]]\nlamp = \"moon\"\n"), HasSubstr("light 'moon': the world has no lamp"));
  EXPECT_THAT(refusal("[[wall_switch]]\nlamp_line = \"moon\"\n"), HasSubstr("wall_switch 'moon': switches no lamp"));
  EXPECT_THAT(refusal("robot = \"hal\"\n"), HasSubstr("robot 'hal'"));
  EXPECT_THAT(refusal("object = \"ghost\"\n"), HasSubstr("object 'ghost'"));
  EXPECT_THAT(refusal("object = \"cart\"\nobject_part = [{ name = \"green\" }]\n"), HasSubstr("object_part 'green'"));
}

TEST(Scenario, KeysAreJudgedWithFileAndLine) {
  EXPECT_THAT(refusal("[camera]\nedge_samples = 3\n"), HasSubstr("scenario.toml:2: [camera] edge_samples is not 1, 4"));
  EXPECT_THAT(refusal("[[camera_event]]\nwhat = \"melted\"\n"), HasSubstr("scenario.toml:3: camera_event[0].what"));
  EXPECT_THAT(refusal("[base]\nslipp = 0.1\n"), HasSubstr("did you mean slip?"));
}

TEST(Scenario, AWorldThatIsMissingIsNamed) {
  hal::SimulationParameters parameters;
  EXPECT_THAT(SimulatedHome::make(parameters).error().message, HasSubstr("sim.scenario is empty"));
  parameters.scenario = "/nowhere/scenario.toml";
  EXPECT_THAT(SimulatedHome::make(parameters).error().message, HasSubstr("/nowhere/scenario.toml"));
}

TEST(Scenario, AddsPeopleAndMountsTheCameraElsewhere) {
  const ScenarioFile file(
      "robot = \"robot\"\n[camera]\nheight_m = 1.45\ndown_deg = -2.0\n[[person]]\nname = \"somebody\"\nwatches_robot = "
      "true\nwalk = { stop = [{ at_m = [3.0, 3.0, 0.0] }] }\n");
  const auto scenario = load_scenario(file.path(), 1);
  ASSERT_TRUE(scenario) << scenario.error().message;
  ASSERT_EQ(scenario->world.person.size(), 1U);
  EXPECT_TRUE(scenario->world.person.front().watches_robot);
  EXPECT_EQ(scenario->world.robot.front().camera_height_m, 1.45);
  EXPECT_EQ(scenario->world.robot.front().camera_down_deg, -2.0);
  const ScenarioFile plain("robot = \"robot\"\n");
  EXPECT_EQ(load_scenario(plain.path(), 1)->world.robot.front().camera_height_m, 1.20);
}

// The seed leads actors astray by what the file allows, never more, and never from where they begin.
TEST(ScenarioProperty, SeedsMoveTheStopsWithinTheirBound) {
  const ScenarioFile file(
      "[[actor]]\nname = \"cart\"\nastray_m = 0.2\n[actor.walk]\nstop = [{ at_m = [3.0, 3.0, 0.0] }, "
      "{ at_m = [4.0, 3.0, 0.0] }]\n");
  double farthest_m = 0.0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const auto scenario = load_scenario(file.path(), seed);
    ASSERT_TRUE(scenario) << scenario.error().message;
    const auto& stop = scenario->world.object.front().walk.stop;
    EXPECT_EQ(stop[0].at_m, (Triple{3.0, 3.0, 0.0}));
    for (const double off_m : {stop[1].at_m[0] - 4.0, stop[1].at_m[1] - 3.0}) {
      EXPECT_LE(std::abs(off_m), 0.2) << seed;
      farthest_m = std::max(farthest_m, std::abs(off_m));
    }
  }
  EXPECT_GT(farthest_m, 0.19);
}

}  // namespace
}  // namespace cgsr::sim
