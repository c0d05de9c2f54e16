#include "platform/config/catalogue.h"

#include <utility>

#include <fmt/format.h>

#include "platform/config/tree.h"

namespace cgsr::config {
namespace {

/// The shortest text that reads back to the same bits; a negative zero means what a zero means.
std::string spelled(double value) {
  return fmt::to_string(value == 0.0 ? 0.0 : value);
}

std::string quoted(const std::string& text) {
  return one_line(toml::value<std::string>(text));
}

template <class Number>
std::string spelled(Range<Number> range) {
  return fmt::format("{}..{}", range.minimum, range.maximum);
}

}  // namespace

Catalogue::Catalogue(const std::map<std::string, std::string, std::less<>>* written_paths)
    : written_paths_(written_paths) {
  sections_.emplace_back();
}

void Catalogue::number(std::string_view name, int value, Range<int> range, std::string_view unit,
                       std::string_view meaning) {
  add(name, fmt::to_string(value), unit, spelled(range), meaning);
}

void Catalogue::number(std::string_view name, double value, Range<double> range, std::string_view unit,
                       std::string_view meaning) {
  add(name, spelled(value), unit, spelled(range), meaning);
}

void Catalogue::flag(std::string_view name, bool value, std::string_view meaning) {
  add(name, value ? "true" : "false", "", "true, false", meaning);
}

void Catalogue::text(std::string_view name, const std::string& value, std::string_view meaning) {
  add(name, quoted(value), "", "text", meaning);
}

void Catalogue::path(std::string_view name, const std::string& value, std::string_view meaning) {
  const std::string* spelling = &value;
  if (written_paths_ != nullptr) {
    const auto written = written_paths_->find(value);
    if (written != written_paths_->end()) spelling = &written->second;
  }
  add(name, quoted(*spelling), "", "path", meaning);
}

void Catalogue::add_choice(std::string_view name, const std::string& word, const std::string& words,
                           std::string_view meaning) {
  add(name, quoted(word), "", words, meaning);
}

void Catalogue::add_numbers(std::string_view name, const double* values, std::size_t count, Range<double> range,
                            std::string_view unit, std::string_view meaning) {
  std::string list;
  for (std::size_t i = 0; i < count; ++i) list += (i == 0 ? "" : ", ") + spelled(values[i]);
  add(name, '[' + list + ']', unit, "each " + spelled(range), meaning);
}

void Catalogue::add(std::string_view name, std::string value, std::string_view unit, std::string range,
                    std::string_view meaning) {
  if (unit == "1") unit = "";
  sections_[current_].entries.push_back(
      {std::string(name), std::move(value), std::string(unit), std::move(range), std::string(meaning)});
}

std::size_t Catalogue::enter(std::string_view name, std::string_view meaning, bool is_list) {
  const std::string& outer = sections_[current_].path;
  std::string path = outer.empty() ? std::string(name) : fmt::format("{}.{}", outer, name);
  sections_.push_back({std::move(path), std::string(meaning), is_list, {}});
  const std::size_t before = current_;
  current_ = sections_.size() - 1;
  return before;
}

std::string key_path(const Section& section, const Entry& entry) {
  return section.path.empty() ? entry.key : fmt::format("{}.{}", section.path, entry.key);
}

}  // namespace cgsr::config
