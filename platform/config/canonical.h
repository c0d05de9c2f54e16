#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "platform/config/sha256.h"
#include "platform/parameters.h"

namespace cgsr::config {

/// Writes every value of a parameter struct as one TOML line `path.to.key = value`, sorted by path: the same text for
/// every file that means the same, whatever its comments, order, spelling of numbers or omitted defaults. Reading the
/// text gives the struct back.
class Canonical {
 public:
  void number(std::string_view name, int value, Range<int>, std::string_view, std::string_view);
  void number(std::string_view name, double value, Range<double>, std::string_view, std::string_view);
  void flag(std::string_view name, bool value, std::string_view);
  void text(std::string_view name, const std::string& value, std::string_view);

  template <std::size_t kCount>
  void numbers(std::string_view name, const std::array<double, kCount>& values, Range<double>, std::string_view,
               std::string_view) {
    std::string list;
    for (const double value : values) list += (list.empty() ? "" : ", ") + spelled(value);
    lines_[prefix_ + std::string(name)] = "[" + list + "]";
  }

  template <class Enum, class Names>
  void choice(std::string_view name, Enum value, const Names& names, std::string_view meaning) {
    std::string word;  // stays empty, which no reader takes, when the table misses an enumerator
    for (const Named<Enum>& named : names) {
      if (named.value == value) word = named.name;
    }
    text(name, word, meaning);
  }

  template <class Struct>
  void section(std::string_view name, const Struct& value, std::string_view) {
    const std::string outer = prefix_;
    prefix_ += std::string(name) + ".";
    Struct::describe(value, *this);
    prefix_ = outer;
  }

  [[nodiscard]] std::string toml() const;

 private:
  static std::string spelled(double value);

  std::string prefix_;
  std::map<std::string, std::string> lines_;
};

/// \return the canonical text of `parameters`.
template <class Parameters>
std::string canonical(const Parameters& parameters) {
  Canonical writer;
  Parameters::describe(parameters, writer);
  return writer.toml();
}

/// \return the configuration hash that every report prints: SHA-256 of the canonical text, 64 hexadecimal digits. Files
/// that a
///         path-valued key names are not in it.
template <class Parameters>
std::string hash(const Parameters& parameters) {
  return sha256(canonical(parameters));
}

}  // namespace cgsr::config
