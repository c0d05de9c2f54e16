#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/color/search/label_histogram.h"
#include "pipeline/color/search/similarity.h"

namespace cgsr::color {

/// The level of every count for windows of one size: level_of() as a table, of rows.
class LevelTable {
 public:
  LevelTable() : row_of_count_(1 << 16) {}
  /// Makes it for windows of `pixels` pixels and counts up to `max_count` < 65536; nothing to do when it is there already.
  void prepare(int pixels, int max_count);
  [[nodiscard]] const std::uint16_t* data() const { return row_of_count_.data(); }

 private:
  std::vector<std::uint16_t> row_of_count_;  // in bytes from a label's first row
  int pixels_ = 0;
  int max_count_ = 0;
};

/// The best that a histogram reaches under any light; of equal ones the first light.
struct BestLight {
  int units = 0;
  int light = 0;
};

/// Similarity laid out so that one histogram is compared under 32 lights at once: for every (label, level) a row of units, one per
/// light, four SSE vectors; adding up the rows of a histogram's labels gives its similarity under every light.
///
/// Two more sets of rows bound what any window w of a group of windows reaches. Let `most` be a histogram that no window of the group
/// exceeds in any label, `least` one that none falls short of, m and l their levels. Then for any price t >= 0
///
///   sum_label units(w) <= sum_label max_{l <= k <= m} [ units(k) - t p_low(k) ] + t (1 - p_foreign)
///
/// for p_low(k), the least share that counts as level k, sums over the labels of w to at most 1 - p_foreign, p_foreign being the share of
/// pixels that no light knows. t = 0 is the plain bound by monotony; a price on shares keeps it from filling every label of
/// the group to the brim, and makes it several times sharper. units(k) - t p_low(k) rises to one peak and falls, so that the
/// maximum splits into a row for m and a row for l.
///
/// It is the comparison of Alg. 3.2, lines 5 to 7. The bounds are ours; t is the Lagrange multiplier of the sum of the shares.
class SimilarityRows {
 public:
  SimilarityRows(const Similarity& similarity, const SearchParameters& parameters);

  /// \param levels  of the histogram's window size.
  [[nodiscard]] BestLight best(const LabelHistogram& histogram, const LevelTable& levels) const;

  struct Bound {
    int units = kMaxUnits;                                 ///< that no window of the group exceeds under any light.
    bool refinable = false;                                ///< whether refine() can lower it.
    std::array<Lanes, 4 * ((kMaxLights + 31) / 32)> sums;  ///< of the rows of `most`.
  };
  /// Bounds a group by `most` alone. \param levels  of the smallest size in the group.
  void bound(const LabelHistogram& most, const LevelTable& levels, Bound& bound) const;
  /// Lowers the bound of a group of windows of one size. \param min_pixels, pixels  in `least`'s rectangle, in a window.
  void refine(const LabelHistogram& least, const LevelTable& levels, int min_pixels, int pixels, Bound& bound) const;

 private:
  [[nodiscard]] const Lanes* chunk_of(const std::vector<Lanes>& rows, int chunk) const;

  int labels_ = 0;
  int chunks_ = 0;  // of 32 lights
  int price_ = 0;
  std::vector<Lanes> exact_;  // [chunk][label][level][vector]
  std::vector<Lanes> most_;
  std::vector<Lanes> least_;  // empty without a price
};

}  // namespace cgsr::color
