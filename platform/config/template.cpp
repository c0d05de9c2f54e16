#include "platform/config/template.h"

#include <fmt/core.h>
#include <fmt/format.h>

namespace cgsr::config {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string comment_of(std::string_view meaning, const std::string& range, std::string_view unit) {
  if (unit.empty() || unit == "1") return fmt::format("{}  ({})", meaning, range);
  return fmt::format("{}  ({} {})", meaning, range, unit);
}

/// A floating-point number that reads back the same and is seen to be one.
std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace

void Template::number(std::string_view name, int value, Range<int> range, std::string_view unit,
                      std::string_view meaning) {
  line(name, std::to_string(value), comment_of(meaning, fmt::format("{}..{}", range.minimum, range.maximum), unit));
}

void Template::number(std::string_view name, double value, Range<double> range, std::string_view unit,
                      std::string_view meaning) {
  line(name, number_text(value), comment_of(meaning, fmt::format("{}..{}", range.minimum, range.maximum), unit));
}

void Template::numbers_line(std::string_view name, const double* values, std::size_t count, Range<double> range,
                            std::string_view unit, std::string_view meaning) {
  std::string list;
  for (std::size_t i = 0; i < count; ++i) list += (i == 0 ? "" : ", ") + number_text(values[i]);
  line(name, '[' + list + ']', comment_of(meaning, fmt::format("{}..{}", range.minimum, range.maximum), unit));
}

void Template::flag(std::string_view name, bool value, std::string_view meaning) {
  line(name, value ? "true" : "false", std::string(meaning));
}

void Template::text(std::string_view name, const std::string& value, std::string_view meaning) {
  line(name, quoted(value), std::string(meaning));
}

void Template::line(std::string_view name, const std::string& value, const std::string& comment) {
  keys_ += fmt::format("{:<46} # {}\n", fmt::format("{} = {}", name, value), comment);
}

}  // namespace cgsr::config
