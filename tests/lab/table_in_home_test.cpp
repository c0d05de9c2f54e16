#include "tools/lab/table_in_home.h"

#include <gtest/gtest.h>

#include "hal/sim/generator/home.h"

namespace cgsr::lab {
namespace {

constexpr std::uint32_t kHome = 381;  // has a table with its shadow in view

TEST(TableInHome, HasPlacesAboveItInItsShadowAndInTheLight) {
  const auto home = sim::generate_home(kHome);
  ASSERT_TRUE(home) << home.error().message;
  Random random(1);
  const auto table = find_table(*home, random);
  ASSERT_TRUE(table) << table.error().message;
  ASSERT_TRUE(*table);
  for (const Eigen::Vector3d& place : (*table)->above) {
    EXPECT_GT(place.z(), 0.3);  // a ball has air below the top
    EXPECT_LT(place.z(), 1.3);
  }
  for (const auto* places : {&(*table)->in_shade, &(*table)->lit}) {
    for (const Eigen::Vector3d& place : *places) EXPECT_EQ(place.z(), 0.0);
  }
  // No place is both.
  for (const Eigen::Vector3d& shaded : (*table)->in_shade) {
    for (const Eigen::Vector3d& lit : (*table)->lit) EXPECT_FALSE(shaded == lit);
  }
  const double away_m = ((*table)->X_WR.translation() - (*table)->in_shade.front()).head<2>().norm();
  EXPECT_GT(away_m, 0.8);
  EXPECT_LT(away_m, 6.5);
}

TEST(TableInHome, ItsWorldHasOneRobotThereAndOneLampOn) {
  const auto home = sim::generate_home(kHome);
  ASSERT_TRUE(home) << home.error().message;
  Random random(1);
  const auto table = find_table(*home, random);
  ASSERT_TRUE(table && *table);
  const sim::WorldSpec world = world_at(*home, **table);
  ASSERT_EQ(world.robot.size(), 1U);
  EXPECT_TRUE(world.robot.front().has_board);
  EXPECT_DOUBLE_EQ(world.robot.front().start_m[0], (*table)->X_WR.translation().x());
  int on = 0;
  for (std::size_t i = 0; i < home->lights.lamps.size(); ++i) on += world.lamp[i].on ? 1 : 0;
  EXPECT_EQ(on, 1);
  EXPECT_TRUE(world.lamp.front().on);
  EXPECT_EQ(world.lamp.front().name, home->world.lamp[(*table)->lamp].name);
}

}  // namespace
}  // namespace cgsr::lab
