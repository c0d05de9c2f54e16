#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include "src/command.h"

namespace cgsr::app {
namespace {

/// The lab links other people's trackers, the robot's program does not: reproducing is handed to the program beside this one.
int hand_over(const std::vector<std::string>& arguments) {
  std::error_code error;
  const auto lab = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "cgsr-lab";
  if (error || !std::filesystem::exists(lab)) {
    return report(Error{fmt::format("{}: not there; it is built beside cgsr (target cgsr-lab)", lab.string())});
  }
  std::vector<std::string> words{lab.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(lab.c_str(), argv.data());
  return report(Error{fmt::format("{}: cannot be started: {}", lab.string(), std::strerror(errno))});
}

}  // namespace

void add_reproduce_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("reproduce", "the dissertation's tables and figures, ours beside its own");
  command->footer("cgsr reproduce --list names what there is; every further option is explained by cgsr-lab --help.");
  command->allow_extras();
  command->prefix_command();
  command->callback([command, &exit_code] { exit_code = hand_over(command->remaining()); });
}

}  // namespace cgsr::app
