#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "platform/parameters.h"

namespace cgsr::config {

/// Writes what every key means as Markdown: a heading for each section, under it a table of key, unit, range, default
/// and meaning.
class Documentation {
 public:
  Documentation();

  void number(std::string_view name, int value, Range<int> range, std::string_view unit, std::string_view meaning);
  void number(std::string_view name, double value, Range<double> range, std::string_view unit,
              std::string_view meaning);
  void flag(std::string_view name, bool value, std::string_view meaning);
  void text(std::string_view name, const std::string& value, std::string_view meaning);

  template <class Enum, class Names>
  void choice(std::string_view name, Enum value, const Names& names, std::string_view meaning) {
    std::string words;
    std::string word;
    for (const Named<Enum>& named : names) {
      words += (words.empty() ? "" : ", ") + std::string(named.name);
      if (named.value == value) word = named.name;
    }
    row(name, "", words, '"' + word + '"', meaning);
  }

  template <class Struct>
  void section(std::string_view name, const Struct& value, std::string_view meaning) {
    const std::size_t outer = enter(name, meaning);
    Struct::describe(value, *this);
    current_ = outer;
  }

  template <std::size_t kCount>
  void numbers(std::string_view name, const std::array<double, kCount>& values, Range<double> range,
               std::string_view unit, std::string_view meaning) {
    numbers_row(name, values.data(), kCount, range, unit, meaning);
  }

  /// A list is described by one element with its defaults.
  template <class Struct>
  void list(std::string_view name, const std::vector<Struct>&, std::string_view meaning) {
    const std::size_t outer = enter(name, meaning);
    sections_[current_].is_list = true;
    const Struct defaults;
    Struct::describe(defaults, *this);
    current_ = outer;
  }

  void line(int) {}

  [[nodiscard]] std::string markdown() const;

 private:
  struct Section {
    std::string path;
    std::string meaning;
    std::string rows;
    bool is_list = false;
  };

  std::size_t enter(std::string_view name, std::string_view meaning);
  void row(std::string_view name, std::string_view unit, std::string_view range, std::string_view value,
           std::string_view meaning);

  void numbers_row(std::string_view name, const double* values, std::size_t count, Range<double> range,
                   std::string_view unit, std::string_view meaning);

  std::vector<Section> sections_;
  std::size_t current_ = 0;
};

/// \return the tables of a parameter struct's defaults.
template <class Parameters>
std::string markdown() {
  const Parameters defaults;
  Documentation writer;
  Parameters::describe(defaults, writer);
  return writer.markdown();
}

}  // namespace cgsr::config
