// Shell completion out of the command line's own description: what a command offers is asked of CLI11, not written down again.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "src/commands/command.h"

namespace cgsr::app {
namespace {

/// What may follow the words so far: the commands below, and the long options.
std::vector<std::string> offers(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::App* below : command.get_subcommands([](const CLI::App* app) { return !app->get_name().empty(); })) {
    words.push_back(below->get_name());
  }
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  }
  for (const CLI::App* group : command.get_subcommands([](const CLI::App* app) { return app->get_name().empty(); })) {
    for (const CLI::Option* option : group->get_options()) {
      for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
    }
  }
  return words;
}

/// A branch of the script for each command and those below it.
void add_branches(const CLI::App& command, const std::string& path, std::string& script) {
  script += fmt::format("    '{}') words=\"{}\" ;;\n", path, fmt::join(offers(command), " "));
  for (const CLI::App* below : command.get_subcommands([](const CLI::App* app) { return !app->get_name().empty(); })) {
    add_branches(*below, path + " " + below->get_name(), script);
  }
}

/// The branch is chosen by the words that are no options; where no word of it fits, files are offered.
std::string bash_script(const CLI::App& app) {
  std::string branches;
  add_branches(app, "cgsr", branches);
  return "# bash completion for cgsr, printed by `cgsr completion bash`\n"
         "_cgsr() {\n"
         "  local current=\"${COMP_WORDS[COMP_CWORD]}\" path=cgsr next words=\"\" i\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    next=\"$path ${COMP_WORDS[i]}\"\n"
         "    case \"$(_cgsr_words \"$path\")\" in\n"
         "      *\" ${COMP_WORDS[i]} \"*) [[ \"${COMP_WORDS[i]}\" == -* ]] || path=\"$next\" ;;\n"
         "    esac\n"
         "  done\n"
         "  COMPREPLY=($(compgen -W \"$(_cgsr_words \"$path\")\" -- \"$current\"))\n"
         "  if [[ \"$current\" != -* && ( ${#COMPREPLY[@]} -eq 0 || \"$path\" != cgsr ) ]]; then\n"
         "    COMPREPLY+=($(compgen -f -- \"$current\"))\n"
         "  fi\n"
         "}\n"
         "_cgsr_words() {\n"
         "  local words=\"\"\n"
         "  case \"$1\" in\n" +
         branches +
         "  esac\n"
         "  echo \" $words \"\n"
         "}\n"
         "complete -o filenames -F _cgsr cgsr\n";
}

}  // namespace

void add_completion_command(CLI::App& app, int& exit_code) {
  auto list = std::make_shared<bool>(false);
  auto shell = std::make_shared<std::string>();
  auto* command = app.add_subcommand("completion", "print a script that completes commands and options in the shell");
  command->add_option("SHELL", *shell, "the shell")->check(CLI::IsMember({"bash"}));
  command->add_flag("--list", *list, "print the commands instead, each with what it does");
  command->callback([&app, list, shell, &exit_code] {
    exit_code = kSuccess;
    if (*list) {
      for (const CLI::App* below : app.get_subcommands({})) {
        fmt::print("{}\t{}\n", below->get_name(), below->get_description());
      }
    } else {
      fmt::print("{}", bash_script(app));
    }
  });
}

}  // namespace cgsr::app
