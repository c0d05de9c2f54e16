#include "src/commands/hand_over.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/core.h>
#include <unistd.h>

#include "src/commands/command.h"

namespace cgsr::app {

int hand_over(const std::string& name, const std::vector<std::string>& arguments) {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / name;
  if (error || !std::filesystem::exists(program)) {
    return report(Error{fmt::format("{}: not there; it is built beside cgsr (target {})", program.string(), name)});
  }
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  return report(Error{fmt::format("{}: cannot be started: {}", program.string(), std::strerror(errno))});
}

}  // namespace cgsr::app
