#include "tools/lab/counting.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

namespace cgsr::lab {
namespace {

/// Runs a program to its end; what it prints goes to a file. \return its exit code, or -1.
int run_logged(std::vector<std::string> words, const std::filesystem::path& log) {
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = -1;
  const int error = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (error != 0 || waitpid(child, &status, 0) != child) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

Cost cost_of(const nlohmann::json& figures) {
  return {figures.at("mean_minstr").get<double>(), figures.at("worst_minstr").get<double>()};
}

}  // namespace

Result<Counted> count_follow(std::string_view tracker, const std::string& config_file,
                             const std::vector<std::string>& film) {
  const auto scratch = std::filesystem::temp_directory_path() / fmt::format("cgsr-lab-{}.json", getpid());
  const auto log = std::filesystem::path(scratch).replace_extension("log");
  std::vector<std::string> words{
      CGSR_COUNT_TOOL, "--json",    scratch.string(),    "--", std::filesystem::read_symlink("/proc/self/exe").string(),
      "follow",        "--tracker", std::string(tracker)};
  if (!config_file.empty()) words.insert(words.end(), {"--config", config_file});
  words.insert(words.end(), film.begin(), film.end());
  const int code = run_logged(words, log);
  const auto result = nlohmann::json::parse(text_of(scratch), nullptr, false);
  const std::string printed = text_of(log);
  std::error_code ignored;
  std::filesystem::remove(scratch, ignored);
  std::filesystem::remove(log, ignored);
  if (code != 0 || result.is_discarded()) {
    return fail(fmt::format("{}: ended with exit code {}\n{}", fmt::join(words, " "), code, printed));
  }
  Counted counted{{}, cost_of(result.at("image")), result.at("images").get<int>()};
  for (const auto& [name, figures] : result.at("stages").items()) counted.stages[name] = cost_of(figures);
  return counted;
}

}  // namespace cgsr::lab
