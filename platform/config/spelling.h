#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cgsr::config {

/// \return the word that `typed` was probably meant to be: the nearest by insertions, deletions, substitutions and swaps of
///         neighbours (optimal string alignment) if it takes at most a third of its letters; empty when nothing is near.
std::string_view nearest(std::string_view typed, const std::vector<std::string_view>& words);

/// \return `; did you mean NEAREST?`, else `; known: a, b, c`.
std::string hint(std::string_view typed, const std::vector<std::string_view>& words);

}  // namespace cgsr::config
