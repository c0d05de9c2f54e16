#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

namespace cgsr::app {

/// Accepts a finite number in [min, max]. The message names the value and the range; CLI::Range would accept 'nan'.
inline CLI::Validator in_range(double min, double max) {
  const auto check = [min, max](const std::string& word) -> std::string {
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool number = error == std::errc() && end == word.data() + word.size() && std::isfinite(value);
    if (number && value >= min && value <= max) return {};
    return fmt::format("'{}' is not a number in {}..{}", word, min, max);
  };
  return {check, fmt::format("in {}..{}", min, max)};
}

/// Accepts a whole number from 0 that every reader of a number keeps exactly: of an image, or a seed.
inline CLI::Validator whole_number() {
  constexpr double kMax = 9'007'199'254'740'992.0;  // 2^53
  const auto check = [](const std::string& word) -> std::string {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc() && end == word.data() + word.size() && static_cast<double>(value) <= kMax) return {};
    return fmt::format("'{}' is not a whole number from 0", word);
  };
  return {check, "whole number from 0"};
}

/// Adds --force, which lets OutputClaims (src/output/output_claims.h) replace a file of any kind.
inline void add_force_option(CLI::App& command, bool& force) {
  command.add_flag("--force", force, "replace existing files of another kind too (never what the command reads)");
}

}  // namespace cgsr::app
