#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "hal/switches.h"
#include "tests/hal/case_name.h"

namespace cgsr::hal {

/// One set of lines to be held to the contract of hal/switches.h: the outputs "lamp_left" and "lamp_right" and the input "arm", in
/// this order.
struct SwitchesRig {
  std::shared_ptr<void> world;  ///< whatever must outlive the lines: a simulated chip.
  std::unique_ptr<Switches> switches;
  std::function<bool(std::string_view)> level;        ///< what a meter at the line shows, started or not.
  std::function<void(std::string_view, bool)> press;  ///< moves the input from outside.
};

struct SwitchesCase {
  std::string name;
  std::function<SwitchesRig()> make;
  friend void PrintTo(const SwitchesCase& one, std::ostream* out) { *out << one.name; }
};

/// The suite. A test program that includes this header adds an implementation with one line:
///   INSTANTIATE_TEST_SUITE_P(Gpiod, SwitchesContract, testing::Values(SwitchesCase{"gpio_sim", make_gpio_sim}), CaseName());
class SwitchesContract : public testing::TestWithParam<SwitchesCase> {
 protected:
  void SetUp() override {
    rig_ = GetParam().make();
    ASSERT_TRUE(rig_.switches);
  }

  Switches& lines() { return *rig_.switches; }

  SwitchesRig rig_;
};

TEST_P(SwitchesContract, NamesAreThoseOfTheConfigurationInItsOrder) {
  ASSERT_TRUE(lines().start());
  EXPECT_EQ(lines().names(), (std::vector<std::string>{"lamp_left", "lamp_right", "arm"}));
}

TEST_P(SwitchesContract, BeforeStartNothingCanBeSetOrRead) {
  const auto set = lines().set("lamp_left", true);
  ASSERT_FALSE(set);
  EXPECT_NE(set.error().message.find("lamp_left"), std::string::npos);
  EXPECT_FALSE(lines().read("arm"));
  EXPECT_FALSE(rig_.level("lamp_left"));
}

TEST_P(SwitchesContract, StartingTwiceIsAnErrorAndChangesNothing) {
  ASSERT_TRUE(lines().start());
  ASSERT_TRUE(lines().set("lamp_left", true));
  EXPECT_FALSE(lines().start());
  EXPECT_TRUE(rig_.level("lamp_left"));
}

TEST_P(SwitchesContract, OutputsStartOffAndKeepWhatWasSet) {
  ASSERT_TRUE(lines().start());
  EXPECT_EQ(lines().read("lamp_left").value(), false);
  EXPECT_EQ(lines().read("lamp_right").value(), false);
  ASSERT_TRUE(lines().set("lamp_right", true));
  EXPECT_EQ(lines().read("lamp_left").value(), false);
  EXPECT_EQ(lines().read("lamp_right").value(), true);
  EXPECT_TRUE(rig_.level("lamp_right"));
  EXPECT_FALSE(rig_.level("lamp_left"));
  ASSERT_TRUE(lines().set("lamp_right", false));
  EXPECT_EQ(lines().read("lamp_right").value(), false);
  EXPECT_FALSE(rig_.level("lamp_right"));
}

TEST_P(SwitchesContract, InputsAreReadAndCannotBeSet) {
  ASSERT_TRUE(lines().start());
  rig_.press("arm", true);
  EXPECT_EQ(lines().read("arm").value(), true);
  const auto set = lines().set("arm", false);
  ASSERT_FALSE(set);
  EXPECT_NE(set.error().message.find("arm"), std::string::npos);
  EXPECT_EQ(lines().read("arm").value(), true);
  rig_.press("arm", false);
  EXPECT_EQ(lines().read("arm").value(), false);
}

TEST_P(SwitchesContract, UnknownNamesAreNamed) {
  ASSERT_TRUE(lines().start());
  const auto set = lines().set("toaster", true);
  ASSERT_FALSE(set);
  EXPECT_NE(set.error().message.find("toaster"), std::string::npos);
  const auto read = lines().read("");
  EXPECT_FALSE(read);
}

TEST_P(SwitchesContract, StopSwitchesEveryOutputOff) {
  ASSERT_TRUE(lines().start());
  ASSERT_TRUE(lines().set("lamp_left", true));
  ASSERT_TRUE(lines().set("lamp_right", true));
  lines().stop();
  lines().stop();
  EXPECT_FALSE(rig_.level("lamp_left"));
  EXPECT_FALSE(rig_.level("lamp_right"));
  EXPECT_FALSE(lines().read("lamp_left"));
  ASSERT_TRUE(lines().start());
  EXPECT_EQ(lines().read("lamp_left").value(), false);
}

}  // namespace cgsr::hal
