#include "platform/config/canonical.h"

#include <fmt/format.h>

#include "platform/config/tree.h"

namespace cgsr::config {

void Canonical::number(std::string_view name, int value, Range<int>, std::string_view, std::string_view) {
  lines_[prefix_ + std::string(name)] = fmt::to_string(value);
}

void Canonical::number(std::string_view name, double value, Range<double>, std::string_view, std::string_view) {
  lines_[prefix_ + std::string(name)] = spelled(value);
}

// The shortest text that reads back to the same bits; a negative zero means what a zero means.
std::string Canonical::spelled(double value) {
  return fmt::to_string(value == 0.0 ? 0.0 : value);
}

void Canonical::flag(std::string_view name, bool value, std::string_view) {
  lines_[prefix_ + std::string(name)] = value ? "true" : "false";
}

void Canonical::text(std::string_view name, const std::string& value, std::string_view) {
  lines_[prefix_ + std::string(name)] = one_line(toml::value<std::string>(value));
}

std::string Canonical::toml() const {
  std::string text;
  for (const auto& [path, value] : lines_) text += fmt::format("{} = {}\n", path, value);
  return text;
}

}  // namespace cgsr::config
