// How many images a second the simulator draws, camera chain and pinned instruction set included: the home from where the robot starts.
//   build/release/renderer_bench                 two threads
//   build/release/renderer_bench --benchmark_filter=640
// The images/s to look at are of real time; on a busy machine read the processor time: it is what one thread would take.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "hal/sim/render/photographer.h"
#include "hal/sim/worlds/world.h"
#include "platform/config/reader.h"

namespace {

using namespace cgsr;

const sim::World* home() {
  static const auto world = []() -> std::unique_ptr<sim::World> {
    const std::filesystem::path file = std::filesystem::path(CGSR_SOURCE_DIR) / "config/worlds/home.toml";
    const auto spec = config::read_file<sim::WorldSpec>(file);
    if (!spec) return nullptr;
    auto built = sim::build_world(*spec, file);
    return built ? std::make_unique<sim::World>(std::move(*built)) : nullptr;
  }();
  return world.get();
}

// Arguments: width, lamp radius in cm, samples of an edge pixel.
void images(benchmark::State& bench) {
  if (home() == nullptr) return bench.SkipWithError("config/worlds/home.toml does not load");
  sim::World world = *home();
  for (sim::Lamp& lamp : world.scene.lamps) {
    lamp.switch_name.clear();
    lamp.on = lamp.name == "living lamp";
    lamp.radius_m = static_cast<double>(bench.range(1)) / 100.0;
  }
  const auto width = static_cast<int>(bench.range(0));
  const sim::CameraModel camera = sim::CameraModel().scaled_to(width, width * 3 / 4);
  auto photographer = sim::Photographer::make(world.scene, camera, {2, static_cast<int>(bench.range(2))});
  if (!photographer) return bench.SkipWithError(photographer.error().message.c_str());
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(camera.width_px * camera.height_px * 2));
  std::uint64_t number = 0;
  for (auto _ : bench) {
    const double t = static_cast<double>(number) / 30.0;
    const sim::Pose X_WR = sim::pose_at({1.2 + 0.3 * t, 3.2, 0.0}, 0.05 * t);
    const sim::Moment moment{sim::state_at(world.scene, t, {}, {X_WR}), X_WR * sim::mount_of(world.scene.robots[0])};
    benchmark::DoNotOptimize((*photographer)
                                 ->take({moment}, world.sensor, {1, number},
                                        {bytes.data(), camera.width_px, camera.height_px, camera.width_px * 2}));
    number = (number + 1) % 60;
  }
  bench.SetItemsProcessed(bench.iterations());
}

BENCHMARK(images)
    ->ArgNames({"width", "lamp_cm", "edge_samples"})
    ->Args({640, 0, 1})
    ->Args({640, 0, 4})
    ->Args({640, 10, 4})
    ->Args({320, 0, 1})
    ->Args({320, 0, 4})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
