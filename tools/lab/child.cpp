#include "tools/lab/child.h"

#include <fstream>
#include <iterator>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

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

std::string cgsr_program() {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "cgsr").string();
}

}  // namespace

std::filesystem::path scratch_json() {
  return std::filesystem::temp_directory_path() / fmt::format("cgsr-lab-{}.json", getpid());
}

Result<nlohmann::json> run_for_json(const std::vector<std::string>& words, const std::filesystem::path& json) {
  const auto log = std::filesystem::path(json).replace_extension("log");
  const int code = run_logged(words, log);
  auto result = nlohmann::json::parse(text_of(json), nullptr, false);
  const std::string printed = text_of(log);
  std::error_code ignored;
  std::filesystem::remove(json, ignored);
  std::filesystem::remove(log, ignored);
  if (code != 0 || result.is_discarded()) {
    return fail(fmt::format("{}: ended with exit code {}\n{}", fmt::join(words, " "), code, printed));
  }
  return result;
}

Result<nlohmann::json> run_robot(const std::filesystem::path& config, std::uint64_t seed,
                                 const std::vector<std::string>& more) {
  const auto json = scratch_json();
  std::vector<std::string> words{cgsr_program(),       "run",         "--config", config.string(), "--seed",
                                 std::to_string(seed), "--log-level", "warning",  "--json",        json.string()};
  words.insert(words.end(), more.begin(), more.end());
  return run_for_json(words, json);
}

Result<std::string> run_for_text(const std::vector<std::string>& words) {
  const auto log = scratch_json().replace_extension("txt");
  const int code = run_logged(words, log);
  const std::string printed = text_of(log);
  std::error_code ignored;
  std::filesystem::remove(log, ignored);
  if (code != 0) return fail(fmt::format("{}: ended with exit code {}\n{}", fmt::join(words, " "), code, printed));
  return printed;
}

Result<std::string> run_cgsr(std::vector<std::string> words) {
  words.insert(words.begin(), cgsr_program());
  return run_for_text(words);
}

std::vector<std::string> filmed(const std::optional<std::filesystem::path>& videos, const std::string& name) {
  if (!videos) return {};
  std::filesystem::create_directories(*videos);
  const auto path = (*videos / name).string();
  return {"--csv", path + ".csv", "--video", path + ".mkv"};
}

Result<void> write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream out(path);
  out << text;
  if (!out.flush()) return fail(fmt::format("{}: cannot be written", path.string()));
  return {};
}

TableFolder::TableFolder(const std::string& name)
    : path_(std::filesystem::temp_directory_path() / fmt::format("cgsr-{}-{}", name, getpid())) {
  std::filesystem::create_directories(path_);
}

TableFolder::~TableFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace cgsr::lab
