#include "platform/config/canonical.h"

#include <set>

#include <fmt/format.h>

namespace cgsr::config {

std::string to_canonical(const std::vector<Section>& sections) {
  std::set<std::string> lines;
  for (const Section& section : sections) {
    for (const Entry& entry : section.entries) {
      lines.insert(fmt::format("{} = {}\n", key_path(section, entry), entry.value));
    }
  }
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

}  // namespace cgsr::config
