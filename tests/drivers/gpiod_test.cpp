// Lines of this computer: the contract of switches on a scripted chip, and what happens when a line fails.

#include <cerrno>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "hal/gpiod/gpiod_switches.h"
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
  int requested = 0;
};

class ScriptedLines final : public LineAccess {
 public:
  explicit ScriptedLines(ScriptedChip& chip) : chip_(chip) {}

  Result<int> request(const LineWish& wish) override {
    if (wish.name == chip_.missing) return fail("there is no line '" + wish.name + "'");
    lines_.push_back(wish);
    ++chip_.requested;
    if (wish.output) chip_.level[wish.name] = wish.active_low;
    return static_cast<int>(lines_.size()) - 1;
  }
  int set(int line, bool on) override {
    const auto& wish = lines_.at(static_cast<std::size_t>(line));
    if (wish.name == chip_.broken) return EIO;
    chip_.level[wish.name] = on != wish.active_low;
    return 0;
  }
  int read(int line, bool& on) override {
    const auto& wish = lines_.at(static_cast<std::size_t>(line));
    if (wish.name == chip_.broken) return EIO;
    on = chip_.level[wish.name] != wish.active_low;
    return 0;
  }
  void release_all() override {
    chip_.requested = 0;
    lines_.clear();
  }

 private:
  ScriptedChip& chip_;
  std::vector<LineWish> lines_;
};

std::vector<LineWish> three_lines(bool active_low) {
  return {{"lamp_left", true, active_low}, {"lamp_right", true, active_low}, {"arm", false, active_low}};
}

SwitchesRig scripted_lines(bool active_low) {
  auto chip = std::make_shared<ScriptedChip>();
  for (const char* name : {"lamp_left", "lamp_right", "arm"}) chip->level[name] = active_low;
  SwitchesRig rig;
  rig.switches = std::make_unique<GpiodSwitches>(three_lines(active_low), std::make_unique<ScriptedLines>(*chip));
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
  GpiodSwitches lines{three_lines(false), std::make_unique<ScriptedLines>(chip)};
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

TEST(GpiodKernel, SaysWhatIsWrongWithALine) {
  for (const auto& [name, expected] : std::map<std::string, std::string>{
           {"no such line", "there is no line"}, {"gpiochip99:1", "gpiochip99"}, {"gpiochip0:x", "CHIP:OFFSET"}}) {
    GpiodSwitches lines({{name}}, gpiod::make_line_access());
    const auto started = lines.start();
    ASSERT_FALSE(started) << name;
    EXPECT_NE(started.error().message.find(expected), std::string::npos) << started.error().message;
    EXPECT_NE(started.error().message.find(name), std::string::npos) << started.error().message;
  }
}

}  // namespace
}  // namespace cgsr::hal
