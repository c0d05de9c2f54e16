#include "platform/config/spelling.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace cgsr::config {

namespace {

std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, substitution});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string_view nearest(std::string_view typed, const std::vector<std::string_view>& words) {
  std::string_view best;
  std::size_t fewest = typed.size();
  for (const std::string_view word : words) {
    const std::size_t edits = distance(typed, word);
    const std::size_t allowed = std::max<std::size_t>(1, word.size() / 3);
    if (edits > allowed || edits >= fewest) continue;
    fewest = edits;
    best = word;
  }
  return best;
}

std::string hint(std::string_view typed, const std::vector<std::string_view>& words) {
  const std::string_view meant = nearest(typed, words);
  if (!meant.empty()) return fmt::format("; did you mean {}?", meant);
  return fmt::format("; known: {}", fmt::join(words, ", "));
}

}  // namespace cgsr::config
