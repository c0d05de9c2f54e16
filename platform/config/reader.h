#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "platform/config/document.h"
#include "platform/config/layers.h"
#include "platform/config/provenance.h"
#include "platform/error.h"
#include "platform/parameters.h"

namespace cgsr::config {

/// Fills a parameter struct from a file and the files that it extends, and collects everything that is wrong with any of them, each with the file
/// and line in which it stands: unknown keys and sections (with the nearest known spelling, or their present name), wrong types, values out of
/// range or not finite, unknown words of a choice. A key that no file names keeps its default.
///
/// A section's struct may have `std::string inconsistency() const`: what is wrong with its keys together, empty when
/// nothing is. It is asked once all its keys are good by themselves.
class Reader {
 public:
  explicit Reader(Layers layers);
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  void number(std::string_view name, int& value, Range<int> range, std::string_view unit, std::string_view meaning);
  void number(std::string_view name, double& value, Range<double> range, std::string_view unit,
              std::string_view meaning);
  void flag(std::string_view name, bool& value, std::string_view meaning);
  void text(std::string_view name, std::string& value, std::string_view meaning);

  /// The name of a file, relative to the file in which it stands. \param value  as the program can open it; empty stays empty.
  void path(std::string_view name, std::string& value, std::string_view meaning);

  template <class Enum, class Names>
  void choice(std::string_view name, Enum& value, const Names& names, std::string_view /*meaning*/) {
    std::vector<std::string_view> words;
    words.reserve(std::size(names));
    for (const Named<Enum>& named : names) words.push_back(named.name);
    if (const auto chosen = choose(name, words)) value = names[*chosen].value;
  }

  template <class Struct>
  void section(std::string_view name, Struct& value, std::string_view /*meaning*/) {
    if (!enter(name)) return;
    read_members(value);
    leave();
  }

  /// A fixed count of numbers, such as a point or a colour: `name = [1, 2.5, 0]`.
  template <std::size_t kCount>
  void numbers(std::string_view name, std::array<double, kCount>& values, Range<double> range, std::string_view unit,
               std::string_view /*meaning*/) {
    read_numbers(name, values.data(), kCount, range, unit);
  }

  /// A list of sections, `[[name]]` or `name = [{...}, {...}]`: one struct each, in the order of the file. None is no
  /// mistake.
  template <class Struct>
  void list(std::string_view name, std::vector<Struct>& values, std::string_view /*meaning*/) {
    const std::size_t count = list_length(name);
    for (std::size_t i = 0; i < count; ++i) {
      if (!enter_item(name, i)) continue;
      values.emplace_back();
      read_members(values.back());
      leave();
    }
  }

  /// Notes where the section stands, for what can only be judged later.
  void line(int& value) const;

  /// The outermost struct. \return nothing, or every problem, a line each, in the order of the files and lines.
  template <class Struct>
  Result<void> read(Struct& value) {
    read_members(value);
    return finish();
  }

  /// The same without asking whether the outermost sections go together: for a program that needs only some of them.
  template <class Struct>
  Result<void> read_sections(Struct& value) {
    Struct::describe(value, *this);
    return finish();
  }

  /// \return where the values came from, once they have been read.
  [[nodiscard]] const Provenance& provenance() const;

 private:
  struct State;

  template <class Struct>
  void read_members(Struct& value) {
    const std::size_t problems_before = problem_count();
    Struct::describe(value, *this);
    if constexpr (requires {
                    { value.inconsistency() } -> std::convertible_to<std::string>;
                  }) {
      if (problem_count() == problems_before) complain_of_section(value.inconsistency());
    }
  }

  std::optional<std::size_t> choose(std::string_view name, const std::vector<std::string_view>& words);
  bool enter(std::string_view name);
  std::size_t list_length(std::string_view name);
  bool enter_item(std::string_view name, std::size_t index);
  void read_numbers(std::string_view name, double* values, std::size_t count, Range<double> range,
                    std::string_view unit);
  void leave();
  void complain_of_section(const std::string& inconsistency);
  [[nodiscard]] std::size_t problem_count() const;
  Result<void> finish();

  std::unique_ptr<State> state_;
};

/// \return the parameters of `document`, or every problem at once: `config/home.toml:14: stage.track.budget_us = 90000
/// is not in 100..33000 µs`
template <class Parameters>
Result<Parameters> read(const Document& document) {
  Parameters parameters;
  Reader reader{Layers(document)};
  if (auto outcome = reader.read(parameters); !outcome) return tl::unexpected(outcome.error());
  return parameters;
}

/// \return the parameters of a file that extends no other.
template <class Parameters>
Result<Parameters> read_file(const std::filesystem::path& file) {
  const auto document = Document::load(file);
  if (!document) return tl::unexpected(document.error());
  return read<Parameters>(*document);
}

}  // namespace cgsr::config
