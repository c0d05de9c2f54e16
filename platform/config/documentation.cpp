#include "platform/config/documentation.h"

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

Documentation::Documentation() {
  sections_.push_back({});
}

void Documentation::number(std::string_view name, int value, Range<int> range, std::string_view unit,
                           std::string_view meaning) {
  row(name, unit, fmt::format("{}..{}", range.minimum, range.maximum), fmt::to_string(value), meaning);
}

void Documentation::number(std::string_view name, double value, Range<double> range, std::string_view unit,
                           std::string_view meaning) {
  row(name, unit, fmt::format("{}..{}", range.minimum, range.maximum), fmt::to_string(value), meaning);
}

void Documentation::flag(std::string_view name, bool value, std::string_view meaning) {
  row(name, "", "true, false", value ? "true" : "false", meaning);
}

void Documentation::text(std::string_view name, const std::string& value, std::string_view meaning) {
  row(name, "", "text", '"' + value + '"', meaning);
}

std::size_t Documentation::enter(std::string_view name, std::string_view meaning) {
  const std::string& outer = sections_[current_].path;
  std::string path = outer.empty() ? std::string(name) : fmt::format("{}.{}", outer, name);
  sections_.push_back({std::move(path), std::string(meaning), "", false});
  const std::size_t before = current_;
  current_ = sections_.size() - 1;
  return before;
}

void Documentation::row(std::string_view name, std::string_view unit, std::string_view range, std::string_view value,
                        std::string_view meaning) {
  if (unit == "1") unit = "";
  sections_[current_].rows +=
      fmt::format("| `{}` | {} | {} | {} | {} |\n", name, cell(unit), cell(range), cell(value), cell(meaning));
}

void Documentation::numbers_row(std::string_view name, const double* values, std::size_t count, Range<double> range,
                                std::string_view unit, std::string_view meaning) {
  std::string list;
  for (std::size_t i = 0; i < count; ++i) list += fmt::format("{}{}", i == 0 ? "" : ", ", values[i]);
  row(name, unit, fmt::format("each {}..{}", range.minimum, range.maximum), '[' + list + ']', meaning);
}

std::string Documentation::markdown() const {
  std::string text;
  for (const auto& [path, meaning, rows, is_list] : sections_) {
    const std::string heading = is_list ? "[[" + path + "]]" : "[" + path + "]";
    if (!path.empty()) text += fmt::format("\n## `{}`\n\n{}.\n", heading, meaning);
    if (!rows.empty()) text += "\n| key | unit | range | default | meaning |\n|---|---|---|---|---|\n" + rows;
  }
  return text;
}

}  // namespace cgsr::config
