#include "pipeline/color/search/window_search.h"

#include <algorithm>

#include "pipeline/color/search/label_counts.h"
#include "pipeline/color/search/search_node.h"
#include "pipeline/color/search/similarity.h"
#include "pipeline/color/search/similarity_rows.h"
#include "pipeline/color/search/window_grid.h"

namespace cgsr::color {
namespace {

const SearchLevel& level_at(int level) {
  return kSearchTree[static_cast<std::size_t>(level)];
}

}  // namespace

// Best first: the node with the highest bound is looked into next, until the one that comes up is a window.
struct WindowSearch::State {
  State(const ColorModel& model, const SearchParameters& p, int max_label_pixels, int max_side);

  tl::expected<void, SearchFailure> begin(const imaging::ReducedImage& image, const SearchRequest& question);
  void push(int level, int size, int x, int y);
  void push_window(int size, int x, int y, const CellRect& rect);
  void push_group(int level, int size, int x, int y, const CellRect& rect);
  void expand(const SearchNode& node);
  void take(const SearchNode& node);
  bool advance(WorkBudget* budget);
  void take_what_is_known();
  /// \return whether something that comes up can still be a match.
  [[nodiscard]] bool goes_on() const {
    return !queue.empty() && result.count < request.candidates && queue.front().rank() >= floor_units_;
  }
  [[nodiscard]] bool is_ruled_out(const SearchNode& node) const;
  [[nodiscard]] bool is_of_interest(int units) const { return units >= min_units_ && units >= floor_units_; }
  [[nodiscard]] const WindowSize& window_size(int size) const { return grid.sizes[WindowGrid::size_at(size)]; }

  SearchParameters parameters;
  Labels labels;
  SimilarityRows rows;
  LabelCounts counts;
  LabelHistogram histogram;
  std::array<LevelTable, kMaxSizes> levels;
  std::size_t capacity;
  std::vector<SearchNode> queue;  // a heap

  // Of the question under way. Positions are counted from the region's corner.
  WindowGrid grid;
  SearchRequest request;
  SearchResult result;
  SimilarityRows::Bound bound;
  std::array<GridWindow, kMaxMatches> taken;
  int min_units_ = 0;    // of a match
  int floor_units_ = 0;  // what is below it can no longer be a match
};

WindowSearch::State::State(const ColorModel& model, const SearchParameters& p, int max_label_pixels, int max_side)
    : parameters(p),
      labels(labels_of(model)),
      rows(Similarity(model, p, labels), p),
      counts(labels.count(), max_label_pixels, max_side),
      histogram(labels.count()),
      capacity(static_cast<std::size_t>(max_label_pixels) * static_cast<std::size_t>(p.sizes)) {
  queue.assign(capacity, SearchNode(0, 0, 0, 0, 0, 0));  // touches every page now, not while images come
  queue.clear();
}

tl::expected<void, SearchFailure> WindowSearch::State::begin(const imaging::ReducedImage& image,
                                                             const SearchRequest& question) {
  const auto cells = window_grid(parameters, image, question);
  if (!cells) return tl::unexpected(cells.error());
  grid = *cells;
  request = question;
  result = {};
  for (int size = 0; size < grid.size_count; ++size) result.windows += grid.columns(size) * grid.rows(size);
  // Nodes in the queue have no window in common: there are never more of them than windows.
  if (static_cast<std::size_t>(result.windows) > capacity || !counts.prepare(image, grid))
    return tl::unexpected(SearchFailure::kTooLarge);

  min_units_ = min_units(parameters.divergence, request.max_divergence);
  floor_units_ = -kMaxUnits;
  const WindowSize& largest = window_size(grid.size_count - 1);
  constexpr int kReach =
      kSearchTree[0].positions - 1 + 2 * 3;  // cells that a cover adds: of the group, and to whole blocks
  const long most = static_cast<long>(largest.width + kReach) * (largest.height + kReach) * grid.cell_px * grid.cell_px;
  for (int size = 0; size < grid.size_count; ++size) {
    levels[WindowGrid::size_at(size)].prepare(grid.pixels(size), static_cast<int>(std::min(65535L, most)));
  }
  queue.clear();
  constexpr int kStep = kSearchTree[0].positions;
  for (int y = 0; y < grid.rows(0); y += kStep) {
    for (int x = 0; x < grid.columns(0); x += kStep) push(0, 0, x, y);
  }
  return {};
}

void WindowSearch::State::push(int level, int size, int x, int y) {
  if (x >= grid.columns(size) || y >= grid.rows(size)) return;
  const WindowSize& widest = window_size(level_at(level).all_sizes ? grid.size_count - 1 : size);
  const int reach = level_at(level).positions - 1;
  const CellRect rect{x, y, std::min(x + reach + widest.width, grid.right - grid.left),
                      std::min(y + reach + widest.height, grid.bottom - grid.top)};
  if (level == kWindowLevel) {
    push_window(size, x, y, rect);
  } else {
    push_group(level, size, x, y, rect);
  }
}

void WindowSearch::State::push_window(int size, int x, int y, const CellRect& rect) {
  ++result.examined;
  counts.exact(rect, histogram);
  const BestLight best = rows.best(histogram, levels[WindowGrid::size_at(size)]);
  if (!is_of_interest(best.units)) return;
  const int shortfall = request.candidates == 1 ? 0 : shortfall_units(request.max_shortfall);
  floor_units_ = std::max(floor_units_, best.units - shortfall);
  queue.emplace_back(best.units, kWindowLevel, size, best.light, y, x);
  std::push_heap(queue.begin(), queue.end());
}

void WindowSearch::State::push_group(int level, int size, int x, int y, const CellRect& rect) {
  const SearchLevel& l = level_at(level);
  const LevelTable& table = levels[WindowGrid::size_at(size)];
  bound.units = kMaxUnits;
  bound.refinable = false;
  if (counts.covered_pixels(rect) <= 65535) {
    l.exact ? counts.exact(rect, histogram) : counts.cover(rect, histogram);
    rows.bound(histogram, table, bound);
  }
  if (!is_of_interest(bound.units)) return;

  // What all windows of the group share, from the last one's corner to the first one's.
  const CellRect core{std::min(x + l.positions, grid.columns(size)) - 1, std::min(y + l.positions, grid.rows(size)) - 1,
                      x + window_size(size).width, y + window_size(size).height};
  if (l.refined && bound.refinable && core.left < core.right && core.top < core.bottom) {
    counts.exact(core, histogram);
    const int core_pixels = (core.right - core.left) * (core.bottom - core.top) * grid.cell_px * grid.cell_px;
    rows.refine(histogram, table, core_pixels, grid.pixels(size), bound);
    if (!is_of_interest(bound.units)) return;
  }
  queue.emplace_back(bound.units, level, size, 0, y, x);
  std::push_heap(queue.begin(), queue.end());
}

void WindowSearch::State::expand(const SearchNode& node) {
  const SearchLevel& from = level_at(node.level());
  const SearchLevel& to = level_at(node.level() + 1);
  const bool split_sizes = from.all_sizes && !to.all_sizes;
  const int end = split_sizes ? grid.size_count : node.size() + 1;
  for (int size = node.size(); size < end; ++size) {
    for (int y = 0; y < from.positions; y += to.positions) {
      for (int x = 0; x < from.positions; x += to.positions) push(node.level() + 1, size, node.x() + x, node.y() + y);
    }
  }
}

// Whether a match already taken collides with every window of the node. How much of a window another covers falls away from some place to all
// sides, so it is least at one of the group's corners.
bool WindowSearch::State::is_ruled_out(const SearchNode& node) const {
  const SearchLevel& l = level_at(node.level());
  const int end = l.all_sizes ? grid.size_count : node.size() + 1;
  const int right = node.x() + l.positions - 1;
  const int bottom = node.y() + l.positions - 1;
  return std::any_of(taken.begin(), taken.begin() + result.count, [&](const GridWindow& match) {
    for (int size = node.size(); size < end; ++size) {
      for (const GridWindow& corner : {GridWindow{node.x(), node.y(), size},
                                       {right, node.y(), size},
                                       {node.x(), bottom, size},
                                       {right, bottom, size}}) {
        if (!grid.collide(corner, match, request.max_overlap)) return false;
      }
    }
    return true;
  });
}

void WindowSearch::State::take(const SearchNode& node) {
  taken[static_cast<std::size_t>(result.count)] = {node.x(), node.y(), node.size()};
  const GridWindow in_image{grid.left + node.x(), grid.top + node.y(), node.size()};
  result.matches[static_cast<std::size_t>(result.count++)] = {
      grid.box(in_image), divergence_of_units(parameters.divergence, node.rank()), node.light(), node.size()};
}

/// \param budget  nothing: unlimited. \return false when it refused: the node that it was asked for stays in the queue.
bool WindowSearch::State::advance(WorkBudget* budget) {
  while (goes_on()) {
    const SearchNode node = queue.front();
    const bool ruled_out = is_ruled_out(node);
    const bool group = node.level() != kWindowLevel;
    if (!ruled_out && group && budget != nullptr && !budget->grant()) return false;
    std::pop_heap(queue.begin(), queue.end());
    queue.pop_back();
    if (ruled_out) continue;
    group ? expand(node) : take(node);
  }
  return true;
}

/// The windows compared so far, without what no budget was left to look into.
void WindowSearch::State::take_what_is_known() {
  result.exact = false;
  while (goes_on()) {
    std::pop_heap(queue.begin(), queue.end());
    const SearchNode node = queue.back();
    queue.pop_back();
    if (node.level() == kWindowLevel && !is_ruled_out(node)) take(node);
  }
}

WindowSearch::WindowSearch(std::unique_ptr<State> state) : state_(std::move(state)) {}
WindowSearch::WindowSearch(WindowSearch&&) noexcept = default;
WindowSearch& WindowSearch::operator=(WindowSearch&&) noexcept = default;
WindowSearch::~WindowSearch() = default;

Result<WindowSearch> WindowSearch::create(const ColorModel& model, const SearchParameters& parameters, int max_width_px,
                                          int max_height_px) {
  if (auto defect = defect_of(model); !defect.empty()) return fail("the colour model cannot be used, it has " + defect);
  if (parameters.sizes < 1 || parameters.sizes > kMaxSizes) return fail("a search of 1 to 5 window sizes is possible");
  const int factor = imaging::reduction_for(max_width_px, max_height_px, 0.0);
  const int width = std::max(1, max_width_px / factor);
  const int height = std::max(1, max_height_px / factor);
  return WindowSearch(std::make_unique<State>(model, parameters, width * height, std::max(width, height)));
}

const imaging::LabelTable& WindowSearch::labels() const {
  return state_->labels.of_code;
}

tl::expected<SearchResult, SearchFailure> WindowSearch::search(const imaging::ReducedImage& image,
                                                               const SearchRequest& request) {
  if (const auto begun = begin(image, request); !begun) return tl::unexpected(begun.error());
  if (!state_->advance(request.budget)) state_->take_what_is_known();
  return state_->result;
}

tl::expected<void, SearchFailure> WindowSearch::begin(const imaging::ReducedImage& image,
                                                      const SearchRequest& request) {
  return state_->begin(image, request);
}

bool WindowSearch::advance(WorkBudget& budget) {
  return state_->advance(&budget);
}

const SearchResult& WindowSearch::result() const {
  return state_->result;
}

}  // namespace cgsr::color
