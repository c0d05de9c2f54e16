#pragma once

// Internal to reader.cpp and reader_state.cpp: what a Reader remembers, and how its messages are worded.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "platform/config/layers.h"
#include "platform/config/provenance.h"
#include "platform/config/reader.h"
#include "platform/config/tree.h"

namespace cgsr::config {

inline int line_of(const toml::node& node) {
  return static_cast<int>(node.source().begin.line);
}

/// \return the text, cut to what a message can hold.
std::string shortened(std::string ascii);

struct Reader::State {
  /// A section that is being read: its table in every layer, null where a layer has none.
  struct Level {
    std::vector<const toml::table*> tables;
    std::string prefix;  ///< "stage.track."
    std::vector<std::string_view> known;
  };
  /// A value of a key in one layer.
  struct Found {
    std::size_t layer;
    const toml::node* node;
  };
  struct Problem {
    std::size_t layer;
    int line;
    std::string text;
  };

  Layers layers;
  std::vector<Level> levels;
  std::vector<Problem> problems;
  Provenance provenance;

  explicit State(Layers from);

  Level& level() { return levels.back(); }
  [[nodiscard]] const Document& document(std::size_t layer) const { return layers.all()[layer].document; }

  /// Notes that a key is known. \return its value in every layer that has it, the last one being the one that counts.
  std::vector<Found> find(std::string_view name);

  /// Notes which layer gave a key its value.
  void took(std::string_view name, const Found& found);

  void complain(const Found& found, std::string text);
  /// Complains of a section, at its first line.
  void complain_of_level(std::string text);
  void complain_of_type(std::string_view name, const Found& found, std::string_view expected);
  void complain_of_unknown_keys();

  template <class Number>
  void complain_of_range(std::string_view name, const Found& found, Number value, Range<Number> range,
                         std::string_view unit) {
    if (unit == "1") unit = "";  // a count, which nobody says "1" after
    complain(found, fmt::format("{}{} = {} is not in {}..{}{}{}", level().prefix, name, value, range.minimum,
                                range.maximum, unit.empty() ? "" : " ", unit));
  }

  /// \return nothing, or all problems: those of the first file first, each file's in the order of its lines.
  Result<void> outcome();
};

}  // namespace cgsr::config
