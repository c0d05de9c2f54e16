#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "hal/replay/replay_camera.h"
#include "pipeline/color/model_file.h"
#include "pipeline/runtime/schedule.h"
#include "pipeline/world/load.h"
#include "platform/config/canonical.h"
#include "platform/config/template.h"
#include "src/command.h"
#include "src/config/load.h"
#include "src/config/robot_docs.h"
#include "src/input/camera_file.h"
#include "src/input/robot_calibration.h"
#include "src/output/text_file.h"
#include "src/robot/simulation_plugin.h"

namespace cgsr::app {
namespace {

struct Options {
  std::string config = "config/robots/video.toml";
  std::string input;
  std::string model;
  std::string write_docs;
  std::string write_config;
};

/// What the camera will deliver; nothing when that is a problem, which is noted.
std::optional<hal::CameraMode> camera_mode(const config::Robot& robot, std::vector<std::string>& problems) {
  if (robot.camera.source == config::CameraSource::kSim) {
    const auto simulation = robot::load_simulation(robot.sim);
    if (!simulation) {
      problems.push_back(simulation.error().message);
      return std::nullopt;
    }
    for (const std::string& note : (*simulation)->notes()) fmt::print("home      {}\n", note);
    const auto mode = (*simulation)->take_camera()->start();
    if (mode) return *mode;
    problems.push_back(mode.error().message);
    return std::nullopt;
  }
  if (robot.camera.replay.path.empty()) {
    problems.emplace_back("camera.replay.path is empty and no --input is given: no images");
    return std::nullopt;
  }
  auto parameters = robot.camera.replay;
  parameters.pace = hal::ReplayPace::kAsFastAsPossible;
  hal::ReplayCamera camera(parameters);
  const auto mode = camera.start();
  if (mode) return *mode;
  problems.push_back(mode.error().message);
  return std::nullopt;
}

/// What chapter 4 needs.
void look_at_map(const config::RobotLocalization& known, std::vector<std::string>& problems) {
  if (known.map.empty() && known.camera.empty() && known.mount.empty()) return;
  if (known.map.empty()) {
    fmt::print("map       none\n");
  } else if (const auto map = world::load_map(known.map)) {
    fmt::print("map       {} surfaces, {} edges\n", map->surfaces.size(), map->edges.size());
  } else {
    problems.push_back(map.error().message);
  }
  if (const auto camera = read_camera(known.camera); !camera) problems.push_back(camera.error().message);
  if (const auto X_RC = read_mount(known.mount); !X_RC) problems.push_back(X_RC.error().message);
}

/// What chapter 5 needs.
void look_at_board(const config::Robot& robot, std::vector<std::string>& problems) {
  if (robot.probes.board.probes == 0) return;
  const auto camera = read_camera(robot.localization.camera);
  const auto X_RC = read_mount(robot.localization.mount);
  if (!camera || !X_RC) return;  // said already where there is a map
  const auto board = illumination::make_board(robot.probes.board, *X_RC, *camera);
  if (!board) return problems.push_back("probes.board: " + board.error().message);
  if (const auto checked = illumination::check_lamp(*board, robot.lamp); !checked) {
    return problems.push_back("lamp: " + checked.error().message);
  }
  fmt::print("board     {} probes, lamps {:.2f} m above the floor\n", board->probes, robot.lamp.height_m);
}

/// Looks at everything that a run would need, each as far as it can be looked at without moving anything.
std::vector<std::string> problems_of(const config::Robot& robot) {
  std::vector<std::string> problems;
  Duration period = seconds(1.0 / 30.0);
  if (const auto mode = camera_mode(robot, problems)) {
    period = mode->frame_period;
    fmt::print("camera    {}x{} at {:.2f} Hz\n", mode->width_px, mode->height_px, 1.0 / to_seconds(period));
  }
  if (robot.task.kind == config::TaskKind::kRoute) {
    const auto places = behavior::parse_places(robot.task.route.places_m);
    if (places) fmt::print("route     {} places\n", places->size());
    if (!places) problems.push_back(fmt::format("task.route.places_m: {}", places.error().message));
  } else if (robot.run.model.empty() && !robot.run.learn.empty()) {
    fmt::print("object    learned from the first image\n");
  } else if (robot.run.model.empty()) {
    problems.emplace_back("run.model is empty and no --model is given: nothing to follow");
  } else if (auto model = color::load_model(robot.run.model)) {
    fmt::print("object    {:.0f}x{:.0f} px, {} lights, distinctiveness {:.3f} nat\n", model->width_px, model->height_px,
               model->lights.size(), model->distinctiveness);
  } else {
    problems.push_back(model.error().message);
  }
  look_at_map(robot.localization, problems);
  look_at_board(robot, problems);
  if (auto schedule = runtime::Schedule::make(runtime::rows_of(robot.stage), period)) {
    fmt::print("{}", runtime::to_text(*schedule));
  } else {
    problems.push_back(schedule.error().message);
  }
  return problems;
}

int run_check(const Options& options) {
  if (!options.write_docs.empty()) {
    if (auto written = write_file(options.write_docs, config::robot_docs()); !written) return report(written.error());
    return kSuccess;
  }
  if (!options.write_config.empty()) {
    const std::string text = config::to_template(config::Robot{});
    if (auto written = write_file(options.write_config, text); !written) return report(written.error());
    return kSuccess;
  }
  auto robot = config::load_robot(options.config);
  if (!robot) return report(robot.error());
  if (!options.input.empty()) robot->camera.replay.path = options.input;
  if (!options.model.empty()) robot->run.model = options.model;
  const auto problems = problems_of(*robot);
  for (const std::string& problem : problems) report(Error{problem});
  if (!problems.empty()) return kFailure;
  fmt::print("{}: good\nconfiguration {}\n", options.config, config::hash(*robot));
  return kSuccess;
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("check", "check a robot's file, its schedule, camera and model; nothing moves");
  command->add_option("--config", options->config, "the robot's file")->capture_default_str();
  command->add_option("--input", options->input, "images instead of those that the file names");
  command->add_option("--model", options->model, "object instead of the one that the file names");
  command->add_option("--write-docs", options->write_docs, "write the page of all keys (docs/config.md) and end");
  command->add_option("--write-config", options->write_config,
                      "write a robot's file with every key and its default, and end");
  command->callback([options, &exit_code] { exit_code = run_check(*options); });
}

}  // namespace cgsr::app
