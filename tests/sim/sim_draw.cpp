// Draws the views of a world file into PNGs: for whoever edits a world and wants to look at it.
//   sim_draw WORLD.toml OUTPUT_FOLDER [--view NAME] [--width PX] [--threads N] [--plain]
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/sim/render/renderer.h"
#include "hal/sim/render/sensor.h"
#include "hal/sim/scene/map_count.h"
#include "hal/sim/worlds/world.h"
#include "platform/config/reader.h"

namespace {

using namespace cgsr;

// Processor time of all threads: what a busy machine does not change.
double cpu_ms() {
  return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

int draw(const std::string& file, const std::filesystem::path& folder, const std::string& only, int width, int threads,
         bool plain, int repeat) {
  const auto spec = config::read_file<sim::WorldSpec>(file, config::Missing::kTakesDefault);
  if (!spec) return fmt::print(stderr, "{}\n", spec.error().message), 1;
  double start = cpu_ms();
  const auto world = sim::build_world(*spec, file);
  if (!world) return fmt::print(stderr, "{}\n", world.error().message), 1;
  sim::CameraModel camera = sim::CameraModel().scaled_to(width, width * 3 / 4);
  auto renderer = sim::Renderer::make(world->scene, camera, {threads, plain ? 1 : 4});
  if (!renderer) return fmt::print(stderr, "{}\n", renderer.error().message), 1;
  std::size_t triangles = 0;
  for (const auto& part : world->scene.parts) triangles += part.mesh.triangles.size();
  const sim::MapCount map = sim::count_map(world->scene);
  fmt::print("{}: map of {} surfaces and {} edges; {} parts, {} triangles, ready in {:.0f} ms\n", world->scene.name,
             map.surfaces, map.edges, world->scene.parts.size(), triangles, cpu_ms() - start);
  std::vector<sim::World::View> views = world->views;
  for (std::size_t i = 0; i < world->X_WR_start.size(); ++i) {
    const sim::Pose X_RC = sim::mount_of(world->scene.robots[i]);
    views.push_back({world->scene.robots[i].name, world->X_WR_start[i] * X_RC, 0.0});
    if (!world->robot_walks[i]) continue;
    for (const double share : {0.25, 0.43, 0.5, 0.7, 1.0}) {  // along a scripted way
      const double at_s = share * world->robot_walks[i]->duration_s();
      views.push_back({fmt::format("{}-{:.0f}s", world->scene.robots[i].name, at_s),
                       sim::scripted_robots(*world, at_s)[i] * X_RC, at_s});
    }
  }
  sim::SwitchStates all_on;
  for (const auto& lamp : world->scene.lamps) all_on[lamp.switch_name] = lamp.carried_by < 0;
  const sim::Sensor sensor;
  std::vector<cv::Mat> drawn;
  for (const auto& view : views) {
    if (!only.empty() && view.name != only) continue;
    // A robot sees itself, not the other robots of the file.
    auto state = sim::state_at(world->scene, view.at_s, all_on, sim::scripted_robots(*world, view.at_s));
    for (const auto& robot : world->scene.robots) {
      state.presence[static_cast<std::size_t>(robot.figure)].present = robot.name == view.name;
    }
    sim::RadianceImage image;
    cv::Mat yuyv(camera.height_px, camera.width_px, CV_8UC2);
    double draw_ms = 1e9;
    double all_ms = 1e9;
    double luma = 0;
    for (int i = 0; i < repeat; ++i) {
      start = cpu_ms();
      (*renderer)->draw(state, view.X_WC, image);
      draw_ms = std::min(draw_ms, cpu_ms() - start);
      luma = sensor.measure(image, world->sensor, 1, 0,
                            {yuyv.data, yuyv.cols, yuyv.rows, static_cast<std::ptrdiff_t>(yuyv.step)},
                            (*renderer)->workers());
      all_ms = std::min(all_ms, cpu_ms() - start);
    }
    cv::Mat bgr;
    cv::cvtColor(yuyv, bgr, cv::COLOR_YUV2BGR_YUYV);
    const std::string name = (folder / (world->scene.name + "-" + view.name + ".png")).string();
    cv::imwrite(name, bgr);
    drawn.push_back(bgr);
    fmt::print("{}: light {:.1f} ms, with camera {:.1f} ms, mean luma {:.2f}\n", name, draw_ms, all_ms, luma);
  }
  if (drawn.empty()) return fmt::print(stderr, "there is no such view\n"), 1;
  if (drawn.size() % 2 != 0) drawn.push_back(cv::Mat::zeros(drawn[0].size(), drawn[0].type()));
  std::vector<cv::Mat> rows;
  for (std::size_t i = 0; i < drawn.size(); i += 2) {
    cv::Mat row;
    cv::hconcat(drawn[i], drawn[i + 1], row);
    rows.push_back(row);
  }
  cv::Mat sheet;
  cv::vconcat(rows, sheet);
  cv::imwrite((folder / (world->scene.name + "-sheet.png")).string(), sheet);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3)
    return fmt::print(stderr, "usage: sim_draw WORLD.toml FOLDER [--view NAME] [--width PX] [--threads N] [--plain]\n"),
           2;
  std::string view;
  int width = 640;
  int threads = 2;
  int repeat = 1;
  bool plain = false;
  for (int i = 3; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--plain") plain = true;
    if (i + 1 >= argc) break;
    if (option == "--view")
      view = argv[++i];
    else if (option == "--width")
      width = std::stoi(argv[++i]);
    else if (option == "--threads")
      threads = std::stoi(argv[++i]);
    else if (option == "--repeat")
      repeat = std::stoi(argv[++i]);
  }
  return draw(argv[1], argv[2], view, width, threads, plain, repeat);
}
