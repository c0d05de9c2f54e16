#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "pipeline/color/search/divergence.h"
#include "platform/box.h"
#include "platform/parameters.h"
#include "platform/work_budget.h"

namespace cgsr::color {

/// What the bins of a histogram count: all the same, or more where they tell the object from its surroundings (Similarity).
enum class BinWeights : std::uint8_t { kPlain, kSurroundings };

inline constexpr std::array kBinWeightsNames{
    Named<BinWeights>{"plain", BinWeights::kPlain},
    Named<BinWeights>{"surroundings", BinWeights::kSurroundings},
};
constexpr std::string_view to_string(BinWeights weights) {
  return word_in(kBinWeightsNames, weights);
}

/// Which windows Alg. 3.2 compares (line 6), and how (line 7).
struct SearchParameters {
  Divergence divergence = Divergence::kJensenShannon;
  BinWeights weights = BinWeights::kSurroundings;
  double min_weight = 0.1;
  int sizes = 3;
  double size_step = 1.12;
  double max_stride_px = 8.0;
  int min_steps_per_side = 8;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("divergence", self.divergence, kDivergenceNames, "The measure that compares histograms.");
    visit.choice("weights", self.weights, kBinWeightsNames,
                 "With plain all bins have the dissertation's weights; with surroundings, bins that distinguish the "
                 "object from its surroundings weigh more.");
    visit.number("min_weight", self.min_weight, Range{0.0, 1.0}, "", "The smallest weight of a bin.");
    visit.number("sizes", self.sizes, Range{1, 5}, "",
                 "The number of window sizes per image, centred on the expected size.");
    visit.number("size_step", self.size_step, Range{1.01, 2.0}, "", "The ratio of neighbouring window sizes.");
    visit.number("max_stride_px", self.max_stride_px, Range{1.0, 64.0}, "px", "The largest step between windows.");
    visit.number("min_steps_per_side", self.min_steps_per_side, Range{2, 32}, "",
                 "The smallest number of steps per shorter side of the box.");
  }
};

/// The window size with which an image is searched, in camera pixels.
struct SearchSize {
  double width_px = 0.0;
  double height_px = 0.0;
};

inline constexpr int kMaxMatches = 16;
inline constexpr int kMaxSizes = 5;

/// One question to the search.
struct SearchRequest {
  double width_px = 0.0;  ///< the middle size, camera pixels: the learned one, or the last one found.
  double height_px = 0.0;
  double max_divergence =
      0.3;  ///< windows above it are no matches. The lower, the cheaper an image without the object.
  int candidates =
      1;  ///< how many matches at most, 1..kMaxMatches: local maxima, each the best of what the ones before leave.
  double max_overlap =
      0.0;  ///< of two matches at most this share of the smaller one may be covered by the other, 0..1.
  double max_shortfall =
      1.0;  ///< similarity (0..1) by which a further match may rank below the first. The lower, the cheaper.
  std::optional<Box> region;     ///< windows lie wholly inside; nothing: the whole image.
  WorkBudget* budget = nullptr;  ///< asked before each group of windows that is looked into; nothing: unlimited.
};

/// A window and the learned histogram that it is nearest to (Alg. 3.2, lines 8 to 11).
struct Match {
  Box box;  ///< camera pixels, on the grid of strides.
  double divergence = 0.0;
  int light = 0;  ///< index into the model's lights.
  int size = 0;   ///< index into the sizes, 0 the smallest.
};

/// What a search found: no match where no window is below max_divergence (Alg. 3.2, lines 14 to 18).
struct SearchResult {
  std::array<Match, kMaxMatches> matches;  ///< best first. Ties: lower size, then light, then y, then x.
  int count = 0;
  bool exact =
      true;  ///< false: the budget ended the search; what is reported is the best seen, not known to be the best there is.
  bool of_this_image = true;  ///< false: it was found in an earlier image, the present one was not searched.
  int windows = 0;            ///< there were to compare (positions times sizes).
  int examined = 0;           ///< of those had their histogram counted: the measure of work.
};

/// Why an image was not searched.
enum class SearchFailure : std::uint8_t {
  kNoRoom,      ///< no window of any size fits into the image or region.
  kBadRequest,  ///< a size, candidate count, overlap or region that is not finite or out of range.
  kTooLarge,    ///< the image is larger than the search was made for.
};
constexpr std::string_view to_string(SearchFailure failure) {
  switch (failure) {
    case SearchFailure::kNoRoom:
      return "no room";
    case SearchFailure::kBadRequest:
      return "bad request";
    case SearchFailure::kTooLarge:
      return "image too large";
  }
  return "";
}

}  // namespace cgsr::color
