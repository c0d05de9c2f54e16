#pragma once

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "platform/parameters.h"

namespace cgsr::config {

/// Looks a parameter struct's description over: what is wrong with it, a line each.
class Audit {
 public:
  void number(std::string_view name, int value, Range<int> range, std::string_view unit, std::string_view meaning) {
    check_range(name, value, range.minimum, range.maximum);
    check_unit(name, unit);
    check_key(name, meaning);
  }
  void number(std::string_view name, double value, Range<double> range, std::string_view unit,
              std::string_view meaning) {
    check_range(name, value, range.minimum, range.maximum);
    check_unit(name, unit);
    check_key(name, meaning);
  }
  template <std::size_t kCount>
  void numbers(std::string_view name, const std::array<double, kCount>& values, Range<double> range,
               std::string_view unit, std::string_view meaning) {
    for (const double value : values) check_range(name, value, range.minimum, range.maximum);
    check_unit(name, unit);
    check_key(name, meaning);
  }
  void flag(std::string_view name, bool, std::string_view meaning) { check_key(name, meaning); }
  void text(std::string_view name, const std::string&, std::string_view meaning) { check_key(name, meaning); }
  void path(std::string_view name, const std::string&, std::string_view meaning) { check_key(name, meaning); }

  template <class Enum, class Names>
  void choice(std::string_view name, Enum value, const Names& names, std::string_view meaning) {
    check_key(name, meaning);
    if (word_in(names, value).empty()) complain(name, "its default has no word");
  }

  template <class Struct>
  void section(std::string_view name, const Struct& value, std::string_view meaning) {
    check_name(name, meaning);
    const std::string outer = prefix_;
    prefix_ += std::string(name) + '.';
    Struct::describe(value, *this);
    if constexpr (requires { value.inconsistency(); }) {
      if (!value.inconsistency().empty()) complain("", "its defaults disagree: " + value.inconsistency());
    }
    prefix_ = outer;
  }

  [[nodiscard]] const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  void check_range(std::string_view name, double value, double minimum, double maximum) {
    if (!(minimum < maximum) || !std::isfinite(minimum) || !std::isfinite(maximum)) complain(name, "has no range");
    if (!(value >= minimum && value <= maximum)) complain(name, "has a default outside its range");
  }

  // A key that has a dimension ends in its unit.
  void check_unit(std::string_view name, std::string_view unit) {
    for (const std::string_view count : {"", "1", "frames", "nat", "sets", "commands", "cells", "grey levels"}) {
      if (unit == count) return;  // no dimension
    }
    struct Suffix {
      std::string_view unit, suffix;
    };
    static constexpr std::array<Suffix, 28> kSuffixes{{{"K", "_k"},           {"bit/s", "_bitps"},
                                                       {"m", "_m"},           {"s", "_s"},
                                                       {"ms", "_ms"},         {"µs", "_us"},
                                                       {"rad", "_rad"},       {"deg", "_deg"},
                                                       {"px", "_px"},         {"%", "_percent"},
                                                       {"Hz", "_hz"},         {"1/s", "_per_s"},
                                                       {"m/s", "_mps"},       {"m/s²", "_mps2"},
                                                       {"deg/s", "_degps"},   {"1/px", "_per_px"},
                                                       {"rad/s", "_radps"},   {"rad/s²", "_radps2"},
                                                       {"m/s^2", "_mps2"},    {"rad/s^2", "_radps2"},
                                                       {"1/m", "_per_m"},     {"1/(m/s)", "_per_mps"},
                                                       {"1/deg", "_per_deg"}, {"1/(deg/s)", "_per_degps"},
                                                       {"1/rev", "_per_rev"}, {"V", "_v"},
                                                       {"1/V", "_per_v"},     {"V/count", "_v_per_count"}}};
    for (const auto& [known, suffix] : kSuffixes) {
      if (known != unit) continue;
      if (!name.ends_with(suffix)) complain(name, "does not end in its unit " + std::string(suffix));
      return;
    }
    complain(name, "has a unit without a suffix in tests/config/audit.h: " + std::string(unit));
  }

  // The meaning of a key is a sentence; bounds are called min_ and max_.
  void check_key(std::string_view name, std::string_view meaning) {
    check_name(name, meaning);
    const bool sentence =
        !meaning.empty() && meaning.front() >= 'A' && meaning.front() <= 'Z' && meaning.ends_with('.');
    if (!meaning.empty() && !sentence) complain(name, "has a meaning that is no sentence: " + std::string(meaning));
    for (const std::string_view word : {"_most", "_least", "least_", "most_", "largest_", "_limit", "_min_", "_max_"}) {
      if (name.find(word) != name.npos) complain(name, "is a bound that is not called min_ or max_");
    }
  }

  void check_name(std::string_view name, std::string_view meaning) {
    const bool bare = !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == name.npos;
    if (!bare) complain(name, "is not a lower_case name");
    if (meaning.empty()) complain(name, "has no meaning");
    if (!names_.insert(prefix_ + std::string(name)).second) complain(name, "is described twice");
  }

  void complain(std::string_view name, std::string_view what) {
    complaints_.push_back(prefix_ + std::string(name) + ' ' + std::string(what));
  }

  std::string prefix_;
  std::set<std::string> names_;
  std::vector<std::string> complaints_;
};

template <class Parameters>
std::vector<std::string> audit(const Parameters& parameters) {
  Audit auditor;
  Parameters::describe(parameters, auditor);
  return auditor.complaints();
}

}  // namespace cgsr::config
