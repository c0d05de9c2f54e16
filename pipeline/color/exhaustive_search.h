#pragma once

#include <tl/expected.hpp>

#include "pipeline/color/color_model.h"
#include "pipeline/color/search_types.h"
#include "pipeline/imaging/reduce.h"

namespace cgsr::color {

/// Alg. 3.2 as it is written: every window, every size, every light, one after the other. Slow and plain: the oracle that
/// WindowSearch is held to, bit by bit. Same request, same result; `budget` is ignored. Allocates.
///
/// \param image  reduced with the labels of any WindowSearch of this model (or label_table_of).
tl::expected<SearchResult, SearchFailure> exhaustive_search(const ColorModel& model, const SearchParameters& parameters,
                                                            const imaging::ReducedImage& image,
                                                            const SearchRequest& request);

}  // namespace cgsr::color
