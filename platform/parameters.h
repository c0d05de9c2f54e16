#pragma once

#include <string_view>

namespace cgsr {

/// How parameters are written down once and used everywhere.
///
/// A parameter struct is a plain struct of defaults with one static member template that names every field:
///
///     struct FollowParameters {
///       double distance_m = 1.5;
///       Mode mode = Mode::kPlain;
///
///       template <class Self, class Visitor>
///       static void describe(Self& self, Visitor& visit) {
///         visit.number("distance_m", self.distance_m, {0.3, 5.0}, "m", "The distance that the robot keeps from the object.");
///         visit.choice("mode", self.mode, kModeNames, "The search that answers.");
///       }
///     };
///
/// The TOML reader, docs/config.md and the configuration's hash are visitors; none of them repeats a name, a range or a default.
/// A meaning is a full sentence, that of a section a phrase without a full stop. Bounds are called min_ and max_. A visitor has these members:
///   number(name, value&, Range{minimum, maximum}, unit, meaning)   int or double; the range is closed
///   flag(name, value&, meaning)                                    bool
///   text(name, value&, meaning)                                    std::string
///   path(name, value&, meaning)                                    std::string: a file, relative to the configuration file that names it
///   choice(name, value&, table of Named{name, value}, meaning)     any enum
///   section(name, struct&, meaning)                                another parameter struct
template <class T>
struct Range {
  T minimum;
  T maximum;
};
template <class T>
Range(T, T) -> Range<T>;

/// One word of the configuration and the enumerator it stands for.
template <class Enum>
struct Named {
  std::string_view name;
  Enum value;
};

/// What the to_string() of an enum with such a table consists of, so that the table is the only source of its words.
/// \return the word of `value`; empty when the table misses it.
template <class Enum, class Names>
constexpr std::string_view word_in(const Names& names, Enum value) {
  for (const Named<Enum>& named : names) {
    if (named.value == value) return named.name;
  }
  return "";
}

}  // namespace cgsr
