#include <algorithm>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "hal/sim/render/truth_images.h"
#include "pipeline/shade/shadow_volumes.h"
#include "tests/render/free_pose.h"
#include "tests/render/shipped_map.h"
#include "tools/sim/world_file.h"

namespace cgsr::shade {
namespace {

struct Counts {
  double both = 0.0;
  double either = 0.0;
  double truth = 0.0;
  double missed = 0.0;
  double ours = 0.0;

  void add(const std::vector<std::uint8_t>& mask, const std::vector<std::uint8_t>& true_mask) {
    for (std::size_t i = 0; i < mask.size(); ++i) {
      const bool is = mask[i] != 0;
      const bool should = true_mask[i] != 0;
      both += is && should ? 1 : 0;
      either += is || should ? 1 : 0;
      truth += should ? 1 : 0;
      missed += should && !is ? 1 : 0;
      ours += is ? 1 : 0;
    }
  }
};

/// Our masks beside the ray tracer's, at the true pose, lamp and map, through the same lens.
void agree_in(const std::string& name, int poses) {
  const auto world = sim::load_world(std::string(CGSR_SOURCE_DIR) + "/config/worlds/" + name + ".toml");
  ASSERT_TRUE(world) << world.error().message;
  const world::Map map = render::shipped_map(name);
  const sim::CameraModel model = sim::CameraModel().scaled_to(160, 120);
  auto renderer = sim::Renderer::make(world->scene, model, {});
  ASSERT_TRUE(renderer) << renderer.error().message;
  const sim::SceneState state = sim::state_at(world->scene, 0.0);
  ASSERT_FALSE(state.lamps.empty());
  (*renderer)->move_to(state);
  geometry::Camera camera;
  camera.k1 = sim::CameraModel().k1;
  camera.k2 = sim::CameraModel().k2;
  camera.p1 = sim::CameraModel().p1;
  camera.p2 = sim::CameraModel().p2;

  ShadowVolumes volumes(map, {});
  std::mt19937 random(3);
  Counts surface;
  Counts possibly;
  for (int trial = 0; trial < poses; ++trial) {
    const geometry::Pose X_WC = render::free_pose(map, random);
    const auto truth = sim::shadow_masks(**renderer, state, X_WC, 0);
    const ShadeMasks& ours = volumes.look(X_WC, camera, state.lamps[0].p_WL.cast<double>());
    surface.add(ours.surface_shaded, truth.surface_shaded);
    possibly.add(ours.possibly_shaded, truth.possibly_shaded);
  }
  std::printf("[ %s: surface IoU %.4f, possibly IoU %.4f, missed %.4f, area %.3f ]\n", name.c_str(),
              surface.both / surface.either, possibly.both / possibly.either, possibly.missed / possibly.truth,
              possibly.ours / possibly.truth);
  EXPECT_GT(surface.truth, 1000.0);
  EXPECT_GE(surface.both / surface.either, 0.95);
  EXPECT_GE(possibly.both / possibly.either, 0.95);
}

TEST(ShadeTruth, HomeIsShadedAsTheRayTracerSays) {
  agree_in("home", 4);
}
TEST(ShadeTruth, OcclusionIsShadedAsTheRayTracerSays) {
  agree_in("occlusion", 4);
}

}  // namespace
}  // namespace cgsr::shade
