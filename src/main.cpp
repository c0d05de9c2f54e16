#include <exception>
#include <string>

#include <CLI/CLI.hpp>

#include "platform/error.h"
#include "src/commands/command.h"
#include "src/commands/parse_error.h"
#include "src/commands/version.h"

namespace cgsr::app {
namespace {

int run_command_line(int argc, char** argv) {
  CLI::App app("Colour vision for a mobile robot under changing light.", "cgsr");
  app.set_version_flag("--version", std::string("cgsr ") + kVersion);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);

  int exit_code = kSuccess;
  add_run_command(app, exit_code);
  add_profile_command(app, exit_code);
  add_top_command(app, exit_code);
  add_check_command(app, exit_code);
  add_config_command(app, exit_code);
  add_devices_command(app, exit_code);
  add_calibrate_command(app, exit_code);
  add_learn_command(app, exit_code);
  add_track_command(app, exit_code);
  add_map_command(app, exit_code);
  add_localize_command(app, exit_code);
  add_light_command(app, exit_code);
  add_people_command(app, exit_code);
  add_reproduce_command(app, exit_code);
  add_shade_command(app, exit_code);
  add_sim_command(app, exit_code);
  add_completion_command(app, exit_code);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& wrong) {
    return report_parse_error(app, wrong, argc, argv);
  }
  return exit_code;
}

}  // namespace
}  // namespace cgsr::app

int main(int argc, char** argv) {
  try {
    return cgsr::app::run_command_line(argc, argv);
  } catch (const std::exception& surprise) {
    return cgsr::app::report(cgsr::Error{std::string("unexpected: ") + surprise.what()});
  }
}
