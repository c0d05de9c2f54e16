// The files in config/ that the project ships.

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "platform/config/canonical.h"
#include "src/config/load.h"
#include "src/config/localization.h"

namespace cgsr::config {
namespace {

std::vector<std::filesystem::path> robot_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(CGSR_SOURCE_DIR "/config/robots")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  return files;
}

TEST(ShippedRobots, NameEveryKeyAndAreGood) {
  ASSERT_FALSE(robot_files().empty());
  for (const auto& file : robot_files()) {
    const auto robot = load_robot(file);
    EXPECT_TRUE(robot) << robot.error().message;
  }
}

TEST(ShippedRobots, AreSlowNeverBackwardsAndKeptIn) {
  for (const auto& file : robot_files()) {
    const auto robot = load_robot(file);
    ASSERT_TRUE(robot) << robot.error().message;
    EXPECT_LE(robot->motion.max_forward_mps, 0.5) << file;
    EXPECT_EQ(robot->motion.max_backward_mps, 0.0) << file << ": it is blind backwards";
    EXPECT_EQ(robot->follow.max_backward_mps, 0.0) << file;
    EXPECT_LE(robot->motion.goal_timeout_s, 0.150) << file;
    EXPECT_LE(robot->motion.feedback_timeout_s, 0.100) << file;
    EXPECT_TRUE(robot->motion.keep_in.enabled) << file;
  }
}

TEST(ShippedLocalization, AreGoodAndWithoutAFileItIsTheFreeOne) {
  const std::filesystem::path folder = CGSR_SOURCE_DIR "/config/localization";
  const auto free = load_localization(folder / "free.toml");
  ASSERT_TRUE(free) << free.error().message;
  EXPECT_EQ(canonical(*free), canonical(*load_localization({})));
  EXPECT_FALSE(free->tracker.floor);
  const auto floor = load_localization(folder / "floor.toml");
  ASSERT_TRUE(floor) << floor.error().message;
  EXPECT_TRUE(floor->tracker.floor);
}

}  // namespace
}  // namespace cgsr::config
