#include "src/config/listing.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "platform/config/canonical.h"
#include "platform/config/catalogue.h"

namespace cgsr::config {
namespace {

constexpr std::size_t kMaxAlignedValue = 32;

/// \return "config/robots/video.toml:12" or "default".
std::string origin_of(const Robot& robot, const std::string& path) {
  const auto& origins = robot.provenance.origins;
  const auto found = origins.find(path);
  return found == origins.end() ? "default" : fmt::format("{}:{}", found->second.file, found->second.line);
}

/// A section's lines, their values and comments aligned.
std::string aligned(const Robot& robot, const Section& section) {
  std::size_t key_width = 0;
  std::size_t value_width = 0;
  for (const Entry& entry : section.entries) {
    key_width = std::max(key_width, entry.key.size());
    value_width = std::max(value_width, std::min(entry.value.size(), kMaxAlignedValue));
  }
  std::string text;
  for (const Entry& entry : section.entries) {
    text += fmt::format("{:<{}} = {:<{}}  # {}\n", entry.key, key_width, entry.value, value_width,
                        origin_of(robot, key_path(section, entry)));
  }
  return text;
}

/// Values as they are, paths as the program opens them.
std::vector<Section> opened(const Robot& robot) {
  Catalogue visitor;
  Robot::describe(robot, visitor);
  return visitor.sections();
}

}  // namespace

std::string show_text(const Robot& robot) {
  std::string text = fmt::format("# configuration {}\n", hash(robot));
  for (const Section& section : catalogue(robot)) {
    if (section.entries.empty()) continue;
    text += fmt::format("\n[{}]\n{}", section.path, aligned(robot, section));
  }
  return text;
}

std::string diff_text(const Robot& robot, const Robot& other) {
  const auto left = opened(robot);
  const auto right = opened(other);
  std::string text;
  std::size_t keys = 0;
  std::size_t different = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    for (std::size_t j = 0; j < left[i].entries.size(); ++j) {
      ++keys;
      const Entry& a = left[i].entries[j];
      const Entry& b = right[i].entries[j];
      if (a.value == b.value) continue;
      ++different;
      const std::string path = key_path(left[i], a);
      text += fmt::format("{} = {} ({}), {} ({})\n", path, a.value, origin_of(robot, path), b.value,
                          origin_of(other, path));
    }
  }
  return text + fmt::format("{} of {} keys differ\n", different, keys);
}

std::string keys_text(std::string_view pattern) {
  std::string text;
  for (const Section& section : catalogue(Robot())) {
    for (const Entry& entry : section.entries) {
      const std::string path = key_path(section, entry);
      if (path.find(pattern) == std::string::npos) continue;
      const std::string unit = entry.unit.empty() ? "" : " " + entry.unit;
      text += fmt::format("{} = {}{}  ({}{})\n    {}\n", path, entry.value, unit, entry.range, unit, entry.meaning);
    }
  }
  return text;
}

}  // namespace cgsr::config
