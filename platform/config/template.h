#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "platform/parameters.h"

namespace cgsr::config {

/// Writes a parameter struct as a TOML file that a person edits: every key with its value, its meaning beside it.
class Template {
 public:
  void number(std::string_view name, int value, Range<int> range, std::string_view unit, std::string_view meaning);
  void number(std::string_view name, double value, Range<double> range, std::string_view unit,
              std::string_view meaning);
  template <std::size_t kCount>
  void numbers(std::string_view name, const std::array<double, kCount>& values, Range<double> range,
               std::string_view unit, std::string_view meaning) {
    numbers_line(name, values.data(), kCount, range, unit, meaning);
  }
  void flag(std::string_view name, bool value, std::string_view meaning);
  void text(std::string_view name, const std::string& value, std::string_view meaning);

  template <class Enum, class Names>
  void choice(std::string_view name, Enum value, const Names& names, std::string_view meaning) {
    std::string words;
    std::string word;
    for (const Named<Enum>& named : names) {
      words += (words.empty() ? "" : " | ") + std::string(named.name);
      if (named.value == value) word = named.name;
    }
    line(name, '"' + word + '"', std::string(meaning) + "  (" + words + ")");
  }

  template <class Struct>
  void section(std::string_view name, const Struct& value, std::string_view meaning) {
    Template inner;
    inner.path_ = path_.empty() ? std::string(name) : path_ + "." + std::string(name);
    Struct::describe(value, inner);
    if (!inner.keys_.empty()) sections_ += "\n# " + std::string(meaning) + "\n[" + inner.path_ + "]\n" + inner.keys_;
    sections_ += inner.sections_;
  }

  [[nodiscard]] std::string toml() const { return keys_ + sections_; }

 private:
  void numbers_line(std::string_view name, const double* values, std::size_t count, Range<double> range,
                    std::string_view unit, std::string_view meaning);
  void line(std::string_view name, const std::string& value, const std::string& comment);

  std::string path_;
  std::string keys_;
  std::string sections_;
};

/// \return `parameters` as a file to edit.
template <class Parameters>
std::string to_template(const Parameters& parameters) {
  Template writer;
  Parameters::describe(parameters, writer);
  return writer.toml();
}

}  // namespace cgsr::config
