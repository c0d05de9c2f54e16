#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "platform/config/canonical.h"
#include "src/boot/robot.h"
#include "src/commands/command.h"
#include "src/config/load.h"

namespace cgsr::app {
namespace {

struct Options {
  std::string config = "config/robots/video.toml";
  std::string input;
  std::string model;
  bool devices_may_be_late = false;
};

/// What was found, for people.
void print_findings(const boot::RobotState& state) {
  const hal::CameraMode& mode = state.devices.mode;
  if (mode.width_px > 0) {
    fmt::print("camera    {}x{} at {:.2f} Hz\n", mode.width_px, mode.height_px, 1.0 / to_seconds(mode.frame_period));
  }
  for (const std::string& note : state.report.notes) fmt::print("{}\n", note);
  if (state.vision.runner) fmt::print("{}", runtime::to_text(state.vision.runner->schedule()));
}

/// Devices of this computer that are not there are named, and are no reason to refuse the file.
void excuse(const std::vector<std::string>& missing, std::vector<Error>& problems) {
  for (const std::string& device : missing) fmt::print("not there yet: {}\n", device);
  std::erase_if(problems, [&missing](const Error& problem) {
    return std::ranges::find(missing, problem.message) != missing.end();
  });
}

int run_check(const Options& options) {
  auto robot = config::load_robot(options.config);
  if (!robot) return report(robot.error());
  if (!options.input.empty()) robot->camera.replay.path = options.input;
  if (!options.model.empty()) robot->run.model = options.model;
  boot::Robot::Check check = boot::Robot::check(*robot);
  const boot::BootReport& found = check.robot->state().report;
  print_findings(check.robot->state());
  if (options.devices_may_be_late) excuse(found.missing_devices, check.problems);
  for (const Error& problem : check.problems) report(problem);
  for (const std::string& problem : found.problems) report(Error{problem});
  if (!check.problems.empty() || !found.problems.empty()) return kFailure;
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
  command->add_flag("--devices-may-be-late", options->devices_may_be_late,
                    "a camera, CAN interface or line of this computer that is not there is named, but is no failure: "
                    "the service waits for it");
  command->callback([options, &exit_code] { exit_code = run_check(*options); });
}

}  // namespace cgsr::app
