// Lines of this computer: the contract of switches on a scripted chip, and what happens when a line fails.

#include <cerrno>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "hal/gpiod/gpiod_switches.h"
#include "platform/clock.h"
#include "tests/hal/case_name.h"
#include "tests/hal/switches_contract.h"

namespace cgsr::hal {
namespace {

using gpiod::GpiodSwitches;
using gpiod::LineAccess;
using gpiod::LineWish;

/// A chip whose lines have electrical levels. It must outlive its access.
struct ScriptedChip {
  std::map<std::string, bool> level;  ///< electrical, by line.
  std::string broken;                 ///< this line does not answer.
  std::string missing;                ///< there is no such line.
  bool gone = false;                  ///< unplugged: no line is there, and those that are held answer no more for ever.
  int requested = 0;                  ///< lines that are held.
  int attempts = 0;                   ///< requests, granted or not.
  SimulatedClock clock;
};

class ScriptedLines final : public LineAccess {
 public:
  explicit ScriptedLines(ScriptedChip& chip) : chip_(chip) {}

  Result<int> request(const LineWish& wish) override {
    ++chip_.attempts;
    if (wish.name == chip_.missing || chip_.gone) return fail("there is no line '" + wish.name + "'");
    int number = 0;
    while (lines_.count(number) != 0) ++number;
    lines_[number] = {wish};
    ++chip_.requested;
    if (wish.output) chip_.level[wish.name] = wish.active_low;
    return number;
  }
  int set(int number, bool on) override {
    const LineWish& wish = held(number).wish;
    if (const int error = problem(number); error != 0) return error;
    chip_.level[wish.name] = on != wish.active_low;
    return 0;
  }
  int read(int number, bool& on) override {
    const LineWish& wish = held(number).wish;
    if (const int error = problem(number); error != 0) return error;
    on = chip_.level[wish.name] != wish.active_low;
    return 0;
  }
  void release(int number) override { chip_.requested -= static_cast<int>(lines_.erase(number)); }
  void release_all() override {
    chip_.requested = 0;
    lines_.clear();
  }

 private:
  struct Held {
    LineWish wish;
    bool dead = false;  ///< of a chip that was unplugged.
  };
  Held& held(int number) { return lines_.at(number); }
  int problem(int number) {
    Held& line = held(number);
    line.dead = line.dead || chip_.gone;
    return line.dead ? ENODEV : line.wish.name == chip_.broken ? EIO : 0;
  }

  ScriptedChip& chip_;
  std::map<int, Held> lines_;
};

std::vector<LineWish> three_lines(bool active_low) {
  return {{"lamp_left", true, active_low}, {"lamp_right", true, active_low}, {"arm", false, active_low}};
}

SwitchesRig scripted_lines(bool active_low) {
  auto chip = std::make_shared<ScriptedChip>();
  for (const char* name : {"lamp_left", "lamp_right", "arm"}) chip->level[name] = active_low;
  SwitchesRig rig;
  rig.switches =
      std::make_unique<GpiodSwitches>(three_lines(active_low), std::make_unique<ScriptedLines>(*chip), chip->clock);
  rig.level = [chip, active_low](std::string_view name) { return chip->level[std::string(name)] != active_low; };
  rig.press = [chip, active_low](std::string_view name, bool on) { chip->level[std::string(name)] = on != active_low; };
  rig.world = chip;
  return rig;
}

INSTANTIATE_TEST_SUITE_P(Gpiod, SwitchesContract,
                         testing::Values(SwitchesCase{"active_high", [] { return scripted_lines(false); }},
                                         SwitchesCase{"active_low", [] { return scripted_lines(true); }}),
                         CaseName());

struct GpiodFault : testing::Test {
  ScriptedChip chip;
  GpiodSwitches lines{three_lines(false), std::make_unique<ScriptedLines>(chip), chip.clock};
};

TEST_F(GpiodFault, ALineThatDoesNotAnswerIsNamedAndEveryOtherGoesOff) {
  ASSERT_TRUE(lines.start());
  ASSERT_TRUE(lines.set("lamp_left", true));
  chip.broken = "lamp_right";
  const auto set = lines.set("lamp_right", true);
  ASSERT_FALSE(set);
  EXPECT_NE(set.error().message.find("lamp_right"), std::string::npos);
  EXPECT_FALSE(chip.level["lamp_left"]);
  EXPECT_FALSE(lines.read("lamp_left").value());
}

TEST_F(GpiodFault, AnInputThatDoesNotAnswerIsNamed) {
  ASSERT_TRUE(lines.start());
  chip.broken = "arm";
  const auto read = lines.read("arm");
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("arm"), std::string::npos);
}

TEST_F(GpiodFault, WhenOneLineIsMissingNoneIsKept) {
  chip.missing = "arm";
  const auto started = lines.start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().message.find("arm"), std::string::npos);
  EXPECT_EQ(chip.requested, 0);
  EXPECT_FALSE(chip.level["lamp_left"]);
  chip.missing.clear();
  EXPECT_TRUE(lines.start());
}

TEST_F(GpiodFault, AChipThatGoesAwayAndComesBackIsRequestedAgain) {
  ASSERT_TRUE(lines.start());
  ASSERT_TRUE(lines.set("lamp_left", true));
  chip.gone = true;
  const auto read = lines.read("arm");
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("arm"), std::string::npos);
  EXPECT_EQ(chip.requested, 0) << "a line that is held keeps the chip's number";
  chip.clock.advance(gpiod::kLineWait);
  EXPECT_FALSE(lines.read("arm"));
  chip.gone = false;
  EXPECT_FALSE(lines.read("arm")) << "too soon after the last request";
  chip.level["arm"] = true;
  chip.clock.advance(gpiod::kLineWait);
  EXPECT_TRUE(lines.read("arm").value());
}

TEST_F(GpiodFault, LinesThatAreGoneAreRequestedAtABoundedRate) {
  ASSERT_TRUE(lines.start());
  chip.gone = true;
  const int before = chip.attempts;
  for (int look = 0; look < 200; ++look) {  // as the switch worker does, every 50 ms for 10 s
    EXPECT_FALSE(lines.read("arm"));
    chip.clock.advance(seconds(0.05));
  }
  EXPECT_GE(chip.attempts - before, 15);
  EXPECT_LE(chip.attempts - before, 20);
}

TEST_F(GpiodFault, AnOutputThatWasGoneSaysSoBeforeItIsUsedAgain) {
  ASSERT_TRUE(lines.start());
  ASSERT_TRUE(lines.set("lamp_left", true));
  chip.gone = true;
  EXPECT_FALSE(lines.read("arm"));
  chip.gone = false;
  chip.level["lamp_left"] = false;  // without power
  chip.clock.advance(gpiod::kLineWait);
  EXPECT_TRUE(lines.read("arm"));
  EXPECT_FALSE(lines.read("lamp_left").value());
  EXPECT_FALSE(lines.set("lamp_left", true)) << "whoever took it for lit has to hear of it";
  EXPECT_FALSE(chip.level["lamp_left"]);
  chip.clock.advance(gpiod::kLineWait);
  EXPECT_TRUE(lines.set("lamp_left", true));
  EXPECT_TRUE(chip.level["lamp_left"]);
}

TEST_F(GpiodFault, OneLineThatFailsLeavesTheOthersHeld) {
  ASSERT_TRUE(lines.start());
  chip.level["arm"] = true;
  chip.broken = "lamp_right";
  EXPECT_FALSE(lines.set("lamp_right", true));
  EXPECT_EQ(chip.requested, 2);
  EXPECT_TRUE(lines.read("arm").value());
  EXPECT_TRUE(lines.set("lamp_left", true));
  chip.broken.clear();
  chip.clock.advance(gpiod::kLineWait);
  EXPECT_TRUE(lines.set("lamp_right", true));
}

TEST_F(GpiodFault, StopAndStartWhileTheChipIsGone) {
  ASSERT_TRUE(lines.start());
  chip.gone = true;
  EXPECT_FALSE(lines.read("arm"));
  lines.stop();
  EXPECT_FALSE(lines.start());
  chip.gone = false;
  ASSERT_TRUE(lines.start());
  EXPECT_TRUE(lines.set("lamp_left", true));
}

TEST(GpiodKernel, SaysWhatIsWrongWithALine) {
  for (const auto& [name, expected] : std::map<std::string, std::string>{
           {"no such line", "there is no line"}, {"gpiochip99:1", "gpiochip99"}, {"gpiochip0:x", "CHIP:OFFSET"}}) {
    const RealClock clock;
    GpiodSwitches lines({{name}}, gpiod::make_line_access(), clock);
    const auto started = lines.start();
    ASSERT_FALSE(started) << name;
    EXPECT_NE(started.error().message.find(expected), std::string::npos) << started.error().message;
    EXPECT_NE(started.error().message.find(name), std::string::npos) << started.error().message;
  }
}

}  // namespace
}  // namespace cgsr::hal
