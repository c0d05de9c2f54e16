// `cgsr profile`: a run whose summary is where its time went.
#include <memory>

#include <CLI/CLI.hpp>

#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/option_checks.h"
#include "src/commands/run_robot.h"

namespace cgsr::app {

void add_profile_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunCommand>();
  options->log_level = "warning";
  options->run.profile = true;
  auto* command = app.add_subcommand("profile", "run a robot and show the time of each stage against its budget");
  command->add_option("--config", options->config, "the robot's file")->capture_default_str();
  command->add_option("--input", options->input, "images to replay instead of those that the file names");
  command->add_option("--model", options->model, "object to follow instead of the one that the file names");
  command->add_option("--duration", options->run.duration_s, "end after that many seconds")->check(in_range(1e-3, 1e6));
  command->add_flag("--dry-run", options->run.dry_run, "compute and record, command nothing");
  command->add_flag("--arm", options->run.arm, "arm as soon as nothing speaks against it: the robot will move");
  command->add_option("--trace", options->run.trace, "write a trace of stages and control cycles (ui.perfetto.dev)");
  command->add_option("--json", options->json, "write the summary of the run for machines, under \"profile\" this one");
  add_force_option(*command, options->force);
  command->add_option("--log-level", options->log_level, "trace, debug, info, warning, error or off")
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = run_robot(*options); });
}

}  // namespace cgsr::app
