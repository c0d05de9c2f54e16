#include "tools/lab/counting.h"

#include <filesystem>

#include <nlohmann/json.hpp>

#include "tools/lab/child.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {
namespace {

Cost cost_of(const nlohmann::json& figures) {
  return {figures.at("mean_minstr").get<double>(), figures.at("worst_minstr").get<double>(),
          figures.at("worst_second_minstr").get<double>(), figures.value("images", 0)};
}

}  // namespace

Result<Counted> count_program(const std::string& program, const std::vector<std::string>& arguments) {
  const auto scratch = scratch_json();
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  std::vector<std::string> words{source_path("tools/count"), "--json", scratch.string(), "--",
                                 (folder / program).string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const auto result = run_for_json(words, scratch);
  if (!result) return tl::unexpected(result.error());
  const char* const path = result->contains("frame_path") ? "frame_path" : "image";
  Counted counted{{}, cost_of(result->at("image")), cost_of(result->at(path)), result->at("images").get<int>()};
  for (const auto& [name, figures] : result->at("stages").items()) counted.stages[name] = cost_of(figures);
  return counted;
}

Result<Counted> count_lab(const std::vector<std::string>& command, const std::string& config_file) {
  std::vector<std::string> arguments = command;
  if (!config_file.empty()) arguments.insert(arguments.end(), {"--config", config_file});
  return count_program(std::filesystem::read_symlink("/proc/self/exe").filename().string(), arguments);
}

Result<Counted> count_follow(std::string_view tracker, const std::string& config_file,
                             const std::vector<std::string>& film) {
  std::vector<std::string> words{"follow", "--tracker", std::string(tracker)};
  words.insert(words.end(), film.begin(), film.end());
  return count_lab(words, config_file);
}

}  // namespace cgsr::lab
