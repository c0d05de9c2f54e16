#include "tests/render/shipped_map.h"

#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "hal/sim/calibration/map_file.h"
#include "pipeline/world/load.h"
#include "tools/sim/world_file.h"

namespace cgsr::render {

world::Map shipped_map(const std::string& name) {
  const auto world = sim::load_world(std::string(CGSR_SOURCE_DIR) + "/config/worlds/" + name + ".toml");
  if (!world) {
    ADD_FAILURE() << world.error().message;
    return {};
  }
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("cgsr-map-{}-{}", name, getpid());
  std::filesystem::create_directories(folder);
  const auto written = sim::write_map(world->scene, folder / "map.obj", "");
  EXPECT_TRUE(written);
  auto map = world::load_map(folder / "map.obj");
  std::filesystem::remove_all(folder);
  if (!map) {
    ADD_FAILURE() << map.error().message;
    return {};
  }
  return *map;
}

}  // namespace cgsr::render
