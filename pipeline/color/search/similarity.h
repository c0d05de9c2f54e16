#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/color/learn/color_model.h"
#include "pipeline/color/search/search_types.h"
#include "pipeline/imaging/reduce.h"

namespace cgsr::color {

/// Similarity is counted in whole units, so that its sums come out the same in any order: kOne units are two equal histograms.
/// A sum is cut off at kMaxUnits, which rounding alone can reach.
inline constexpr int kOne = 30000;
inline constexpr int kMaxUnits = 32767;

/// A window's share p of a bin is kept as one of kLevels levels, finest where shares are small: p = (level / (kLevels - 1))^2.
inline constexpr int kLevels = 128;

/// \return the level nearest to sqrt(count / pixels), at most kLevels - 1; a count above `pixels` counts as `pixels`. In whole numbers:
///         the largest k with 4 (kLevels - 1)^2 count >= pixels (2k - 1)^2.
int level_of(int count, int pixels);

/// A label per bin that occurs in a learned histogram, 1.., in order of falling mass; 0 for all other bins.
struct Labels {
  std::vector<int> bins;        ///< the bin of each label, from label 1 on.
  imaging::LabelTable of_code;  ///< the label of every colour code.

  [[nodiscard]] int count() const { return static_cast<int>(bins.size()); }
};
Labels labels_of(const ColorModel& model);

/// What every (label, level, light) adds to a window's similarity:
///
///   units = floor(kOne * w * similarity_term(p', q) / W),   W = sum over the bins of w q
///
/// In plain mode w = 1 and p' = p: the dissertation's (Alg. 3.2, line 7). With surroundings (negatives as in section 6.2.2), under each light
/// separately, because the same light falls on them: w = max(q / (q + s), min_weight), s the surroundings' share of the bin, and
/// p' = min(p, q): what a colour that counts has in excess must not make up for one that is missing.
class Similarity {
 public:
  Similarity(const ColorModel& model, const SearchParameters& parameters, const Labels& labels);

  [[nodiscard]] int lights() const { return lights_; }
  [[nodiscard]] int labels() const { return labels_; }
  /// \param label  1..labels(). \return rises with the level.
  [[nodiscard]] std::int16_t units(int label, int level, int light) const {
    return units_[static_cast<std::size_t>((label - 1) * kLevels + level) * static_cast<std::size_t>(lights_) +
                  static_cast<std::size_t>(light)];
  }

 private:
  int lights_ = 0;
  int labels_ = 0;
  std::vector<std::int16_t> units_;  // [label][level][light]
};

/// What a further match may lack of the first, in units.
inline int shortfall_units(double max_shortfall) {
  return static_cast<int>(max_shortfall * kOne);
}

/// \return the divergence that `units` of similarity stand for.
double divergence_of_units(Divergence divergence, int units);

/// \return the least units whose divergence is at most `max_divergence`; kMaxUnits + 1 when none are.
int min_units(Divergence divergence, double max_divergence);

}  // namespace cgsr::color
