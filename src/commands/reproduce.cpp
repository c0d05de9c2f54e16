#include <CLI/CLI.hpp>

#include "src/commands/command.h"
#include "src/commands/hand_over.h"

namespace cgsr::app {

/// The lab links other people's trackers, the robot's program does not.
void add_reproduce_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("reproduce", "the dissertation's tables and figures, ours beside its own");
  command->footer("cgsr reproduce --list names what there is; every further option is explained by cgsr-lab --help.");
  command->allow_extras();
  command->prefix_command();
  command->callback([command, &exit_code] { exit_code = hand_over("cgsr-lab", command->remaining()); });
}

}  // namespace cgsr::app
