#include "pipeline/color/search/window_grid.h"

#include <algorithm>
#include <cmath>

namespace cgsr::color {
namespace {

constexpr double kMaxSide = 1 << 14;

bool in(double value, double low, double high) {
  return value >= low && value <= high;  // a NaN is not
}

bool is_sound(const SearchRequest& request) {
  if (!in(request.width_px, 1.0, kMaxSide) || !in(request.height_px, 1.0, kMaxSide)) return false;
  if (!in(request.max_divergence, 0.0, 1.0) || !in(request.max_overlap, 0.0, 1.0) ||
      !in(request.max_shortfall, 0.0, 1.0)) {
    return false;
  }
  if (request.candidates < 1 || request.candidates > kMaxMatches) return false;
  if (request.region) {
    const Box& r = *request.region;
    if (!in(r.x, -kMaxSide, kMaxSide) || !in(r.y, -kMaxSide, kMaxSide) || !in(r.width, 0.0, kMaxSide) ||
        !in(r.height, 0.0, kMaxSide)) {
      return false;
    }
  }
  return true;
}

void limit_to(const Box& region, WindowGrid& grid) {
  const double cell = grid.cell_px * grid.factor;
  const auto cut = [](double value, int limit) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
  };
  grid.left = cut(std::ceil(region.x / cell), grid.right);
  grid.top = cut(std::ceil(region.y / cell), grid.bottom);
  grid.right = cut(std::floor((region.x + region.width) / cell), grid.right);
  grid.bottom = cut(std::floor((region.y + region.height) / cell), grid.bottom);
}

void add_sizes(const SearchParameters& parameters, const SearchRequest& request, WindowGrid& grid) {
  const double cell = grid.cell_px * grid.factor;
  for (int i = 0; i < parameters.sizes; ++i) {
    const double scale = std::pow(parameters.size_step, i - (parameters.sizes - 1) / 2);
    const auto cells = [&](double side_px) {
      return std::max(1, static_cast<int>(std::lround(side_px * scale / cell)));
    };
    const WindowSize size{cells(request.width_px), cells(request.height_px)};
    if (grid.size_count > 0) {
      const WindowSize& last = grid.sizes[WindowGrid::size_at(grid.size_count - 1)];
      if (last.width == size.width && last.height == size.height) continue;
    }
    if (size.width > grid.right - grid.left || size.height > grid.bottom - grid.top) continue;
    if (size.width * size.height * grid.cell_px * grid.cell_px > kMaxWindowPixels) continue;
    grid.sizes[WindowGrid::size_at(grid.size_count++)] = size;
  }
}

}  // namespace

Box WindowGrid::box(const GridWindow& window) const {
  const double cell = cell_px * factor;
  const WindowSize& size = sizes[size_at(window.size)];
  return {window.x * cell, window.y * cell, size.width * cell, size.height * cell};
}

bool WindowGrid::collide(const GridWindow& a, const GridWindow& b, double max_overlap) const {
  const WindowSize& of_a = sizes[size_at(a.size)];
  const WindowSize& of_b = sizes[size_at(b.size)];
  const int width = std::min(a.x + of_a.width, b.x + of_b.width) - std::max(a.x, b.x);
  const int height = std::min(a.y + of_a.height, b.y + of_b.height) - std::max(a.y, b.y);
  if (width <= 0 || height <= 0) return false;
  return width * height > max_overlap * std::min(of_a.width * of_a.height, of_b.width * of_b.height);
}

tl::expected<WindowGrid, SearchFailure> window_grid(const SearchParameters& parameters,
                                                    const imaging::ReducedImage& image, const SearchRequest& request) {
  if (!is_sound(request)) return tl::unexpected(SearchFailure::kBadRequest);
  WindowGrid grid;
  grid.factor = image.factor;
  const double shorter_px = std::min(request.width_px, request.height_px);
  const double stride_px = std::min(parameters.max_stride_px, shorter_px / parameters.min_steps_per_side);
  grid.cell_px = std::max(1, static_cast<int>(stride_px / image.factor));
  grid.right = image.width_px / grid.cell_px;
  grid.bottom = image.height_px / grid.cell_px;
  if (request.region) limit_to(*request.region, grid);
  add_sizes(parameters, request, grid);
  if (grid.size_count == 0) return tl::unexpected(SearchFailure::kNoRoom);
  return grid;
}

}  // namespace cgsr::color
