#include <string>

#include <gtest/gtest.h>

#include "hal/sim/calibration/map_file.h"
#include "pipeline/world/load.h"
#include "tests/world/scratch.h"
#include "tests/world/small_maps.h"
#include "tools/sim/world_file.h"

namespace cgsr::world {
namespace {

struct Expected {
  const char* name;
  std::size_t surfaces;
  std::size_t edges;
  int borders;
  int materials;
};

class WorldMapGolden : public testing::TestWithParam<Expected> {};

// What the simulator exports comes in whole: planar has the dissertation's 169 surfaces and 456 edges (4.3.2).
TEST_P(WorldMapGolden, HasAsManySurfacesAndEdges) {
  const Expected& expected = GetParam();
  const ScratchFolder scratch;
  const auto world = sim::load_world(std::string(CGSR_SOURCE_DIR) + "/config/worlds/" + expected.name + ".toml");
  ASSERT_TRUE(world) << world.error().message;
  ASSERT_TRUE(sim::write_map(world->scene, scratch / "map.obj", "golden"));
  const auto map = load_map(scratch / "map.obj");
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->surfaces.size(), expected.surfaces);
  EXPECT_EQ(map->edges.size(), expected.edges);
  EXPECT_EQ(count(*map, EdgeKind::kBorder), expected.borders);
  EXPECT_EQ(count(*map, EdgeKind::kMaterial), expected.materials);
  for (const Surface& surface : map->surfaces) EXPECT_TRUE(map->materials[surface.material].known_color);
}

INSTANTIATE_TEST_SUITE_P(Worlds, WorldMapGolden,
                         testing::Values(Expected{"planar", 169, 456, 236, 220}, Expected{"home", 547, 1049, 42, 12},
                                         Expected{"occlusion", 71, 147, 10, 0}, Expected{"spl-field", 85, 240, 136, 0},
                                         Expected{"corridor", 222, 449, 27, 5}, Expected{"people", 70, 141, 4, 0}),
                         [](const auto& world) {
                           std::string name = world.param.name;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace cgsr::world
