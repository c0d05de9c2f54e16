#include <memory>
#include <optional>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "platform/config/canonical.h"
#include "platform/stop.h"
#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/light_run.h"
#include "src/commands/option_checks.h"
#include "src/output/progress.h"

namespace cgsr::app {
namespace {

int run_light(const LightOptions& options) {
  StopRequest stop;
  const StopOnSignals signals(stop);
  std::optional<EndAtOnceOnSignals> loading(std::in_place, kInterrupted);
  auto run = LightRun::open(options);
  if (!run) return report(run.error());
  loading.reset();
  Progress progress;
  bool ended = false;
  while (!stop.requested() && !ended) {
    const auto more = run->step();
    if (!more) return report(more.error());
    ended = !*more;
    progress.show(fmt::format("image {}: a lamp in {}", run->images(), run->answered()));
  }
  if (auto finished = run->finish(); !finished) return report(finished.error());
  fmt::print("{} images{}, a lamp found in {}\n", run->images(), ended ? "" : " until it was stopped", run->answered());
  for (const std::string& line : run->summary()) fmt::print("{}\n", line);
  if (!options.csv.empty()) fmt::print("rows     {}\n", options.csv);
  fmt::print("configuration {}\n", config::hash(run->config()));
  if (ended && run->answered() == 0) return report(Error{fmt::format("no lamp in any image: {}", run->last_cause())});
  return ended ? kSuccess : kInterrupted;
}

}  // namespace

void add_light_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<LightOptions>();
  auto* command =
      app.add_subcommand("light", "locate lamps by the shadows of the robot's probes (Alg. 5.1, Eq. 5.1, 5.2)");
  command
      ->add_option("--config", options->config,
                   "board, probes and lamp: a file as config/illumination/lamp-robot.toml, or a robot's file")
      ->required();
  command->add_option("--camera", options->camera, "YAML of ROS's camera_calibration")->required();
  command->add_option(
      "--mount", options->mount,
      "robot.toml of cgsr calibrate or cgsr sim export, instead of the configuration's [mount] and board");
  command->add_option("--input", options->input, "video, image folder or image")->required();
  command->add_option(
      "--pose", options->pose,
      "CSV with the robot's pose for each image: lamps are kept in the world's frame as well; columns sigma_m and "
      "sigma_deg may say how well it is known, at the least as [lamp].min_pose_sigma_m and _deg");
  command->add_option(
      "--csv", options->csv,
      "write a row for each lamp of each image: robot frame, or the world's where --pose says where the robot was");
  add_force_option(*command, options->force);
  command->callback([options, &exit_code] { exit_code = run_light(*options); });
}

}  // namespace cgsr::app
