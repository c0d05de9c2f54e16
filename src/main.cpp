#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "platform/config/spelling.h"
#include "platform/error.h"
#include "src/command.h"
#include "src/version.h"

namespace cgsr::app {
namespace {

/// \return what to try instead of a word, ' (did you mean ...?)' or nothing.
std::string suggestion(std::string_view typed, const std::vector<std::string>& known) {
  const std::string_view near = config::nearest(typed, {known.begin(), known.end()});
  return near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near);
}

/// \return the first option of the command line that the chosen command does not have, with the nearest that it has; empty: none.
std::string unknown_option(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = &app;
  std::vector<std::string> known;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (!word.starts_with("--")) {
      const auto named = command->get_subcommands([&](const CLI::App* each) { return each->check_name(word); });
      if (!named.empty()) command = named.front();
      continue;
    }
    const std::string name = word.substr(0, word.find('='));
    if (name == "--" || command->get_option_no_throw(name) != nullptr) continue;
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& other : option->get_lnames()) known.push_back("--" + other);
    }
    return fmt::format("there is no option '{}'{}; cgsr {} --help names them", name, suggestion(name, known),
                       command == &app ? "" : command->get_name());
  }
  return {};
}

int run_command_line(int argc, char** argv) {
  CLI::App app("Colour vision for a mobile robot under changing light.", "cgsr");
  app.set_version_flag("--version", std::string("cgsr ") + kVersion);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);

  int exit_code = kSuccess;
  add_run_command(app, exit_code);
  add_check_command(app, exit_code);
  add_config_command(app, exit_code);
  add_calibrate_command(app, exit_code);
  add_learn_command(app, exit_code);
  add_track_command(app, exit_code);
  add_map_command(app, exit_code);
  add_localize_command(app, exit_code);
  add_light_command(app, exit_code);
  add_reproduce_command(app, exit_code);
  add_shade_command(app, exit_code);
  add_sim_command(app, exit_code);

  const std::string first = argc > 1 ? argv[1] : "";
  const auto named = [&first](const CLI::App* command) { return command->check_name(first); };
  if (!first.empty() && first.front() != '-' && app.get_subcommands(named).empty()) {
    std::vector<std::string> known;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
      known.push_back(command->get_name());
    }
    report(Error{fmt::format("there is no command '{}'{}; cgsr --help names them", first, suggestion(first, known))});
    return kUsage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& wrong) {
    const std::string unknown = wrong.get_exit_code() == 0 ? "" : unknown_option(app, argc, argv);
    if (!unknown.empty()) {
      report(Error{unknown});
      return kUsage;
    }
    return app.exit(wrong) == 0 ? kSuccess : kUsage;
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
