#pragma once

#include <tl/expected.hpp>

#include "pipeline/color/learn/color_model.h"
#include "pipeline/color/search/search_types.h"
#include "pipeline/color/search/similarity.h"
#include "pipeline/imaging/reduce.h"

namespace cgsr::color {

/// Alg. 3.2 as it is written: every window, every size, every light, one after the other. Slow and plain: the oracle that
/// WindowSearch is held to, bit by bit. Same question, same answer; a budget is not asked. Allocates.
class ExhaustiveSearch {
 public:
  /// \param model  without defect.
  ExhaustiveSearch(const ColorModel& model, const SearchParameters& parameters);

  /// \return as WindowSearch::labels().
  [[nodiscard]] const imaging::LabelTable& labels() const { return labels_.of_code; }

  [[nodiscard]] tl::expected<SearchResult, SearchFailure> search(const imaging::ReducedImage& image,
                                                                 const SearchRequest& request) const;

 private:
  SearchParameters parameters_;
  Labels labels_;
  Similarity similarity_;
};

}  // namespace cgsr::color
