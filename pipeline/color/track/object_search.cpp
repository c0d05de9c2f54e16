#include "pipeline/color/track/object_search.h"

#include <algorithm>
#include <utility>

namespace cgsr::color {

Result<ObjectSearch> ObjectSearch::create(const ColorModel& model, const TrackParameters& parameters, int max_width_px,
                                          int max_height_px) {
  auto settings = parameters.search;
  if (parameters.mode == TrackMode::kPlain) {
    settings.weights = BinWeights::kPlain;
    settings.sizes = 1;
  }
  auto search = WindowSearch::create(model, settings, max_width_px, max_height_px);
  if (!search) return tl::unexpected(search.error());
  return ObjectSearch(std::move(*search), parameters, std::min(model.width_px, model.height_px));
}

ObjectSearch::ObjectSearch(WindowSearch search, const TrackParameters& parameters, double shorter_side_px)
    : search_(std::move(search)),
      max_divergence_(parameters.max_divergence),
      candidates_(parameters.mode == TrackMode::kPlain ? 1 : parameters.candidates),
      shorter_side_px_(shorter_side_px) {}

SearchResult ObjectSearch::search(const imaging::ReducedImage& reduced, const SearchSize& size, WorkBudget& budget) {
  SearchRequest request;
  request.width_px = size.width_px;
  request.height_px = size.height_px;
  request.max_divergence = max_divergence_;
  request.candidates = candidates_;
  request.budget = &budget;
  return search_.search(reduced, request).value_or(SearchResult{});
}

}  // namespace cgsr::color
