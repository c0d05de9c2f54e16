#include "platform/config/documentation.h"

#include <string_view>

#include <fmt/format.h>

namespace cgsr::config {
namespace {

/// A cell of a Markdown table must not hold the sign that ends it.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

}  // namespace

std::string to_markdown(const std::vector<Section>& sections) {
  std::string text;
  for (const Section& section : sections) {
    const std::string heading = section.is_list ? "[[" + section.path + "]]" : "[" + section.path + "]";
    const char* const stop = section.meaning.ends_with('.') ? "" : ".";
    if (!section.path.empty()) text += fmt::format("\n## `{}`\n\n{}{}\n", heading, section.meaning, stop);
    if (section.entries.empty()) continue;
    text += "\n| key | unit | range | default | meaning |\n|---|---|---|---|---|\n";
    for (const Entry& entry : section.entries) {
      text += fmt::format("| `{}` | {} | {} | {} | {} |\n", entry.key, cell(entry.unit), cell(entry.range),
                          cell(entry.value), cell(entry.meaning));
    }
  }
  return text;
}

}  // namespace cgsr::config
