#include <CLI/CLI.hpp>

#include "src/commands/command.h"
#include "src/commands/hand_over.h"

namespace cgsr::app {

/// The simulator's tools link a ray tracer, the robot's program does not.
void add_sim_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("sim", "simulated worlds: render, export, run, info");
  command->footer("cgsr sim --help explains the rest; docs/simulator.md shows it.");
  command->set_help_flag();  // --help too is for the program that answers
  command->allow_extras();
  command->prefix_command();
  command->callback([command, &exit_code] { exit_code = hand_over("cgsr-sim", command->remaining()); });
}

}  // namespace cgsr::app
