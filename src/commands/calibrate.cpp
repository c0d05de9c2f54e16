#include <CLI/CLI.hpp>

#include "src/commands/command.h"

namespace cgsr::app {

void add_calibrate_command(CLI::App& app, int& exit_code) {
  auto* command =
      app.add_subcommand("calibrate", "camera, its place on the robot, its probes, and odometry, with residuals");
  command->require_subcommand(1);
  add_calibrate_camera(*command, exit_code);
  add_calibrate_mount(*command, exit_code);
  add_calibrate_probes(*command, exit_code);
  add_calibrate_odometry(*command, exit_code);
}

}  // namespace cgsr::app
