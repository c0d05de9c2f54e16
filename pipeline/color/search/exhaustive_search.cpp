#include "pipeline/color/search/exhaustive_search.h"

#include <algorithm>
#include <tuple>
#include <vector>

#include "pipeline/color/search/similarity.h"
#include "pipeline/color/search/window_grid.h"

namespace cgsr::color {
namespace {

struct Candidate {
  int units = 0;  // similarity: the higher the better
  int light = 0;
  GridWindow window;

  // Best first; the order of ties is part of the contract.
  friend bool operator<(const Candidate& a, const Candidate& b) {
    return std::tuple(-a.units, a.window.size, a.light, a.window.y, a.window.x) <
           std::tuple(-b.units, b.window.size, b.light, b.window.y, b.window.x);
  }
};

std::vector<int> histogram_of(const imaging::ReducedImage& image, const WindowGrid& grid, const GridWindow& window,
                              int labels) {
  const WindowSize& size = grid.sizes[WindowGrid::size_at(window.size)];
  std::vector<int> counts(static_cast<std::size_t>(labels) + 1, 0);
  for (int y = window.y * grid.cell_px; y < (window.y + size.height) * grid.cell_px; ++y) {
    for (int x = window.x * grid.cell_px; x < (window.x + size.width) * grid.cell_px; ++x) {
      ++counts[image.labels[static_cast<std::size_t>(y * image.width_px + x)]];
    }
  }
  return counts;
}

Candidate best_light(const Similarity& similarity, const std::vector<int>& counts, int pixels) {
  std::vector<int> units(static_cast<std::size_t>(similarity.lights()), 0);
  for (int label = 1; label <= similarity.labels(); ++label) {
    const int level = level_of(counts[static_cast<std::size_t>(label)], pixels);
    for (int light = 0; light < similarity.lights(); ++light)
      units[static_cast<std::size_t>(light)] += similarity.units(label, level, light);
  }
  for (auto& sum : units) sum = std::min(sum, kMaxUnits);
  const auto best = std::max_element(units.begin(), units.end());
  Candidate candidate;
  candidate.units = *best;
  candidate.light = static_cast<int>(best - units.begin());
  return candidate;
}

}  // namespace

ExhaustiveSearch::ExhaustiveSearch(const ColorModel& model, const SearchParameters& parameters)
    : parameters_(parameters), labels_(labels_of(model)), similarity_(model, parameters, labels_) {}

tl::expected<SearchResult, SearchFailure> ExhaustiveSearch::search(const imaging::ReducedImage& image,
                                                                   const SearchRequest& request) const {
  const auto grid = window_grid(parameters_, image, request);
  if (!grid) return tl::unexpected(grid.error());
  const int least = min_units(parameters_.divergence, request.max_divergence);

  SearchResult result;
  std::vector<Candidate> candidates;
  for (int size = 0; size < grid->size_count; ++size) {
    for (int y = grid->top; y < grid->top + grid->rows(size); ++y) {
      for (int x = grid->left; x < grid->left + grid->columns(size); ++x) {
        const GridWindow window{x, y, size};
        Candidate candidate =
            best_light(similarity_, histogram_of(image, *grid, window, labels_.count()), grid->pixels(size));
        candidate.window = window;
        if (candidate.units >= least) candidates.push_back(candidate);
        ++result.windows;
      }
    }
  }
  result.examined = result.windows;

  std::sort(candidates.begin(), candidates.end());
  std::vector<GridWindow> taken;
  for (const auto& candidate : candidates) {
    if (result.count == request.candidates) break;
    if (candidate.units < candidates.front().units - shortfall_units(request.max_shortfall)) break;
    const bool free = std::none_of(taken.begin(), taken.end(), [&](const GridWindow& other) {
      return grid->collide(candidate.window, other, request.max_overlap);
    });
    if (!free) continue;
    taken.push_back(candidate.window);
    result.matches[static_cast<std::size_t>(result.count++)] = {
        grid->box(candidate.window), divergence_of_units(parameters_.divergence, candidate.units), candidate.light,
        candidate.window.size};
  }
  return result;
}

}  // namespace cgsr::color
