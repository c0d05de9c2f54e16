#include "src/commands/parse_error.h"

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "platform/config/spelling.h"
#include "src/commands/command.h"

namespace cgsr::app {
namespace {

/// What a command line leads to, word by word.
struct Walk {
  const CLI::App* command;
  std::string typed;  ///< the commands so far.
};

std::string suggestion(std::string_view typed, const std::vector<std::string>& known) {
  const std::string_view near = config::nearest(typed, {known.begin(), known.end()});
  return near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near);
}

/// \return what is wrong with a word that begins with two dashes; empty: the command has that option.
std::string unknown_option(const Walk& walk, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  if (name == "--" || walk.command->get_option_no_throw(name) != nullptr) return {};
  std::vector<std::string> known;
  for (const CLI::Option* option : walk.command->get_options()) {
    for (const std::string& other : option->get_lnames()) known.push_back("--" + other);
  }
  return fmt::format("there is no option '{}'{}; {} --help names them", name, suggestion(name, known), walk.typed);
}

/// Follows a word to the command of that name. \return what is wrong where a command must stand and none has that name.
std::string unknown_command(Walk& walk, const std::string& word) {
  const auto commands = walk.command->get_subcommands([](const CLI::App*) { return true; });
  std::vector<std::string> known;
  for (const CLI::App* each : commands) {
    if (each->check_name(word)) {
      walk = {each, walk.typed + ' ' + word};
      return {};
    }
    known.push_back(each->get_name());
  }
  const auto positionals = walk.command->get_options([](const CLI::Option* each) { return each->get_positional(); });
  if (known.empty() || !positionals.empty()) return {};
  return fmt::format("there is no command '{}'{}; {} --help names them", word, suggestion(word, known), walk.typed);
}

std::string misspelt(const CLI::App& app, int argc, char** argv) {
  Walk walk{&app, app.get_name()};
  bool after_option = false;  // the word may be its value
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool option = word.starts_with('-');
    std::string wrong;
    if (word.starts_with("--")) wrong = unknown_option(walk, word);
    if (!option && !after_option) wrong = unknown_command(walk, word);
    if (!wrong.empty()) return wrong;
    after_option = option;
  }
  return {};
}

}  // namespace

int report_parse_error(const CLI::App& app, const CLI::ParseError& wrong, int argc, char** argv) {
  if (const std::string message = misspelt(app, argc, argv); !message.empty()) {
    fmt::print(stderr, "error: {}\n", message);
    return kUsage;
  }
  return app.exit(wrong) == 0 ? kSuccess : kUsage;
}

}  // namespace cgsr::app
