#include "tools/lab/counting.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

namespace cgsr::lab {
namespace {

/// Runs a program to its end with its standard output thrown away. \return its exit code, or -1.
int run_quietly(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = -1;
  const int error = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (error != 0 || waitpid(child, &status, 0) != child) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

Cost cost_of(const nlohmann::json& figures) {
  return {figures.at("mean_minstr").get<double>(), figures.at("worst_minstr").get<double>()};
}

}  // namespace

Result<Counted> count_follow(std::string_view tracker, const std::string& config_file,
                             const std::vector<std::string>& film) {
  const std::filesystem::path scratch =
      std::filesystem::temp_directory_path() / fmt::format("cgsr-lab-{}.json", getpid());
  std::vector<std::string> words{
      CGSR_COUNT_TOOL, "--json",    scratch.string(),    "--", std::filesystem::read_symlink("/proc/self/exe").string(),
      "follow",        "--tracker", std::string(tracker)};
  if (!config_file.empty()) words.insert(words.end(), {"--config", config_file});
  words.insert(words.end(), film.begin(), film.end());
  const int code = run_quietly(words);
  const auto result = nlohmann::json::parse(std::ifstream(scratch), nullptr, false);
  std::error_code ignored;
  std::filesystem::remove(scratch, ignored);
  if (code != 0 || result.is_discarded()) {
    return fail(fmt::format("{}: counting ended with exit code {}", fmt::join(words, " "), code));
  }
  Counted counted{{}, cost_of(result.at("image")), result.at("images").get<int>()};
  for (const auto& [name, figures] : result.at("stages").items()) counted.stages[name] = cost_of(figures);
  return counted;
}

}  // namespace cgsr::lab
