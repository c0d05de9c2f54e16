#pragma once

#include <array>

#include <tl/expected.hpp>

#include "pipeline/color/search/search_types.h"
#include "pipeline/imaging/reduce.h"

namespace cgsr::color {

/// A window size in cells.
struct WindowSize {
  int width = 0;
  int height = 0;
};

/// A window of a grid: its corner's cell and the index of its size.
struct GridWindow {
  int x = 0;
  int y = 0;
  int size = 0;
};

/// Which windows a request means: the one definition that every search shares. The label image is cut into square cells of one stride;
/// a window is a rectangle of whole cells.
/// Its windows are the regions of Alg. 3.2, line 6; the stride and the sizes are ours.
struct WindowGrid {
  int factor = 2;   ///< camera pixels per label pixel.
  int cell_px = 1;  ///< side of a cell in label pixels: the stride.
  int left = 0;     ///< the region, in cells: [left, right) x [top, bottom).
  int top = 0;
  int right = 0;
  int bottom = 0;
  std::array<WindowSize, kMaxSizes> sizes;  ///< rising.
  int size_count = 0;

  /// Pixels of a window of this size, in label pixels: what its histogram sums to when every pixel has a label.
  [[nodiscard]] int pixels(int size) const {
    return sizes[size_at(size)].width * sizes[size_at(size)].height * cell_px * cell_px;
  }
  /// Positions of a size along an axis; 0 when it does not fit.
  [[nodiscard]] int columns(int size) const { return right - left - sizes[size_at(size)].width + 1; }
  [[nodiscard]] int rows(int size) const { return bottom - top - sizes[size_at(size)].height + 1; }
  /// The window in camera pixels.
  [[nodiscard]] Box box(const GridWindow& window) const;

  /// Whether of two windows more than `max_overlap` of the smaller one is covered by the other.
  [[nodiscard]] bool collide(const GridWindow& a, const GridWindow& b, double max_overlap) const;

  static std::size_t size_at(int size) { return static_cast<std::size_t>(size); }
};

/// The largest window, in label pixels: counts stay within 16 bits.
inline constexpr int kMaxWindowPixels = 60000;

/// Stride: at most max_stride_px and at most the shorter side over min_steps_per_side, whole label pixels, at least one. Sizes: the one asked
/// for times size_step^k, k = -(n-1)/2 .. n/2, rounded to whole cells, at least one; sizes that fall together are one size, and those that do not fit
/// into the image or region, or exceed kMaxWindowPixels, are left out.
tl::expected<WindowGrid, SearchFailure> window_grid(const SearchParameters& parameters,
                                                    const imaging::ReducedImage& image, const SearchRequest& request);

}  // namespace cgsr::color
