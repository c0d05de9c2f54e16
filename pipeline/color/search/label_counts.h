#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/color/search/label_histogram.h"
#include "pipeline/color/search/window_grid.h"
#include "pipeline/imaging/reduce.h"

namespace cgsr::color {

/// A rectangle of cells, counted from the corner of the grid's region.
struct CellRect {
  int left = 0;
  int top = 0;
  int right = 0;   ///< exclusive
  int bottom = 0;  ///< exclusive
};

/// How many pixels of each label lie in any rectangle of cells: an integral histogram (Porikli 2005) over blocks of a few cells,
/// and over the labels only. Counts have 16 bits and wrap in the sums; a rectangle of at most 65535 pixels comes out right.
class LabelCounts {
 public:
  /// \param max_label_pixels, max_side  of the largest label image: its pixels and its longer side.
  LabelCounts(int labels, int max_label_pixels, int max_side);

  /// Counts the region of `grid`. \return false when the image is larger than was reserved for.
  bool prepare(const imaging::ReducedImage& image, const WindowGrid& grid);

  /// The least rectangle of whole blocks that covers `rect`: cheap, and never less than the counts in `rect`.
  void cover(const CellRect& rect, LabelHistogram& histogram) const;
  /// Exactly `rect`: the nearest rectangle of whole blocks, with strips of pixels added or taken away.
  void exact(const CellRect& rect, LabelHistogram& histogram) const;
  /// \return pixels that cover() counts, at most.
  [[nodiscard]] long covered_pixels(const CellRect& rect) const;

 private:
  /// Counts the pixels of a row of blocks, adding the row above: one line of the integral.
  void add_row(int row, const Lanes* above, Lanes* here);
  void sum_blocks(const CellRect& blocks, LabelHistogram& histogram) const;
  void add_strip(const CellRect& cells, LabelHistogram& histogram) const;
  void take_strip(const CellRect& cells, LabelHistogram& histogram) const;
  [[nodiscard]] const std::uint16_t* labels_at(int cell_x, int cell_y) const {
    return labels_ + static_cast<std::ptrdiff_t>(cell_y * cell_px_) * label_stride_ + cell_x * cell_px_;
  }
  [[nodiscard]] const Lanes* corner(int block_x, int block_y) const {
    return sums_.data() + (static_cast<std::ptrdiff_t>(block_y) * (columns_ + 1) + block_x) * running_.vectors();
  }

  int cell_px_ = 1;
  int block_cells_ = 2;
  int cells_across_ = 0;
  int cells_down_ = 0;
  int columns_ = 0;  // of blocks; the last may be cut off
  int rows_ = 0;
  const std::uint16_t* labels_ = nullptr;  // at the region's corner
  int label_stride_ = 0;
  std::vector<Lanes> sums_;  // (rows + 1) x (columns + 1) histograms
  LabelHistogram running_;   // of the blocks of a row so far
};

}  // namespace cgsr::color
