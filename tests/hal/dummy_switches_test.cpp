#include "hal/dummy/dummy_switches.h"

#include <gtest/gtest.h>

namespace cgsr::hal {
namespace {

TEST(DummySwitchesFault, NamesMustBeThereAndDiffer) {
  DummySwitches nameless({{"lamp"}, {""}});
  ASSERT_FALSE(nameless.start());
  DummySwitches twice({{"lamp"}, {"arm", LineDirection::kInput}, {"lamp"}});
  const auto started = twice.start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().message.find("lamp"), std::string::npos);
}

TEST(DummySwitches, InputsReadWhatTheConfigurationSaidUntilPressed) {
  DummySwitches lines({{"arm", LineDirection::kInput, true}});
  ASSERT_TRUE(lines.start());
  EXPECT_EQ(lines.read("arm").value(), true);
  EXPECT_TRUE(lines.press("arm", false));
  EXPECT_EQ(lines.read("arm").value(), false);
  EXPECT_FALSE(lines.press("lamp", true));
}

TEST(DummySwitches, AnOutputCannotBePressed) {
  DummySwitches lines({{"lamp"}});
  ASSERT_TRUE(lines.start());
  EXPECT_FALSE(lines.press("lamp", true));
  EXPECT_EQ(lines.read("lamp").value(), false);
}

}  // namespace
}  // namespace cgsr::hal
