#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "platform/config/provenance.h"
#include "platform/parameters.h"

namespace cgsr::config {

/// A key of a configuration with its present value.
struct Entry {
  std::string key;
  std::string value;  ///< as TOML, so that it reads back to the same bits.
  std::string unit;   ///< empty: none.
  std::string range;  ///< "0..1.5", "each -5..5", "skip, stop_motion", "text".
  std::string meaning;
};

/// A section with the keys that stand directly in it.
struct Section {
  std::string path;  ///< "stage.track"; empty for the outermost.
  std::string meaning;
  bool is_list = false;
  std::vector<Entry> entries;
};

/// Lists the sections and keys of a parameter struct in their order: what the hash, the reference and every listing are made from.
class Catalogue {
 public:
  /// \param written_paths  how paths of files are spelled (Provenance); null: as they are.
  explicit Catalogue(const std::map<std::string, std::string, std::less<>>* written_paths = nullptr);

  void number(std::string_view name, int value, Range<int> range, std::string_view unit, std::string_view meaning);
  void number(std::string_view name, double value, Range<double> range, std::string_view unit,
              std::string_view meaning);
  void flag(std::string_view name, bool value, std::string_view meaning);
  void text(std::string_view name, const std::string& value, std::string_view meaning);
  void path(std::string_view name, const std::string& value, std::string_view meaning);

  template <std::size_t kCount>
  void numbers(std::string_view name, const std::array<double, kCount>& values, Range<double> range,
               std::string_view unit, std::string_view meaning) {
    add_numbers(name, values.data(), kCount, range, unit, meaning);
  }

  template <class Enum, class Names>
  void choice(std::string_view name, Enum value, const Names& names, std::string_view meaning) {
    std::string words;
    for (const Named<Enum>& named : names) words += (words.empty() ? "" : ", ") + std::string(named.name);
    const std::string word(word_in(names, value));  // empty, which no reader takes, when the table misses an enumerator
    add_choice(name, word, words, meaning);
  }

  template <class Struct>
  void section(std::string_view name, const Struct& value, std::string_view meaning) {
    const std::size_t outer = enter(name, meaning, false);
    Struct::describe(value, *this);
    current_ = outer;
  }

  /// A list is described by one element with its defaults.
  template <class Struct>
  void list(std::string_view name, const std::vector<Struct>&, std::string_view meaning) {
    const std::size_t outer = enter(name, meaning, true);
    const Struct defaults;
    Struct::describe(defaults, *this);
    current_ = outer;
  }

  void line(int) {}

  [[nodiscard]] const std::vector<Section>& sections() const { return sections_; }

 private:
  std::size_t enter(std::string_view name, std::string_view meaning, bool is_list);
  void add(std::string_view name, std::string value, std::string_view unit, std::string range,
           std::string_view meaning);
  void add_choice(std::string_view name, const std::string& word, const std::string& words, std::string_view meaning);
  void add_numbers(std::string_view name, const double* values, std::size_t count, Range<double> range,
                   std::string_view unit, std::string_view meaning);

  const std::map<std::string, std::string, std::less<>>* written_paths_;
  std::vector<Section> sections_;
  std::size_t current_ = 0;
};

/// \return the sections of `parameters`, the outermost first. Paths of files are spelled as their files have them where it is known.
template <class Parameters>
std::vector<Section> catalogue(const Parameters& parameters) {
  const std::map<std::string, std::string, std::less<>>* written = nullptr;
  if constexpr (requires { parameters.provenance; }) written = &parameters.provenance.written_paths;
  Catalogue visitor(written);
  Parameters::describe(parameters, visitor);
  return visitor.sections();
}

/// \return "stage.track.budget_us"
std::string key_path(const Section& section, const Entry& entry);

}  // namespace cgsr::config
