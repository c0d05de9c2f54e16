#include "pipeline/color/search/label_counts.h"

#include <algorithm>
#include <utility>

namespace cgsr::color {
namespace {

// Blocks of two cells: coarser ones save work on the sums and lose more by loose covers; of cells of one pixel four, to bound the memory.
constexpr int kSmallestBlockPx = 4;

int block_cells_for(int cell_px) {
  return 2 * cell_px >= kSmallestBlockPx ? 2 : 4;
}

// Every pixel of the image passes here: unrolled for the widths of blocks and cells.
template <int kSign, std::size_t... kPixel>
void count_row(const std::uint16_t* labels, std::uint16_t* counts, std::index_sequence<kPixel...>) {
  ((counts[labels[kPixel]] = static_cast<std::uint16_t>(counts[labels[kPixel]] + kSign)), ...);
}

template <int kSign, int kWidth>
void count_block(const std::uint16_t* labels, std::ptrdiff_t stride, int height, std::uint16_t* counts) {
  for (; height > 0; --height, labels += stride) count_row<kSign>(labels, counts, std::make_index_sequence<kWidth>());
}

template <int kSign>
void count_wide(const std::uint16_t* labels, std::ptrdiff_t stride, int width, int height, std::uint16_t* counts) {
  for (; height > 0; --height, labels += stride) {
    int x = 0;
    for (; x + 8 <= width; x += 8) count_row<kSign>(labels + x, counts, std::make_index_sequence<8>());
    for (; x < width; ++x) count_row<kSign>(labels + x, counts, std::make_index_sequence<1>());
  }
}

// Adds kSign to its label's count for every pixel of a rectangle.
template <int kSign>
void count_pixels(const std::uint16_t* labels, std::ptrdiff_t stride, int width, int height, std::uint16_t* counts) {
  switch (width) {
    case 1:
      return count_block<kSign, 1>(labels, stride, height, counts);
    case 2:
      return count_block<kSign, 2>(labels, stride, height, counts);
    case 3:
      return count_block<kSign, 3>(labels, stride, height, counts);
    case 4:
      return count_block<kSign, 4>(labels, stride, height, counts);
    case 6:
      return count_block<kSign, 6>(labels, stride, height, counts);
    case 8:
      return count_block<kSign, 8>(labels, stride, height, counts);
    default:
      return count_wide<kSign>(labels, stride, width, height, counts);
  }
}

}  // namespace

LabelCounts::LabelCounts(int labels, int max_label_pixels, int max_side) : running_(labels) {
  const int blocks = max_label_pixels / (kSmallestBlockPx * kSmallestBlockPx);
  const int borders =
      4 * (max_side / kSmallestBlockPx + 2);  // the line and column of zeros, and blocks that are cut off
  sums_.resize(static_cast<std::size_t>(blocks + borders) * static_cast<std::size_t>(running_.vectors()));
}

bool LabelCounts::prepare(const imaging::ReducedImage& image, const WindowGrid& grid) {
  cell_px_ = grid.cell_px;
  block_cells_ = block_cells_for(cell_px_);
  cells_across_ = grid.right - grid.left;
  cells_down_ = grid.bottom - grid.top;
  columns_ = (cells_across_ + block_cells_ - 1) / block_cells_;
  rows_ = (cells_down_ + block_cells_ - 1) / block_cells_;
  label_stride_ = image.width_px;
  labels_ = image.labels.data();
  labels_ = labels_at(grid.left, grid.top);
  const auto line = static_cast<std::size_t>(columns_ + 1) * static_cast<std::size_t>(running_.vectors());
  if (line * static_cast<std::size_t>(rows_ + 1) > sums_.size()) return false;

  std::fill_n(sums_.data(), line, Lanes{});
  for (int row = 0; row < rows_; ++row) {
    Lanes* above = sums_.data() + static_cast<std::size_t>(row) * line;
    add_row(row, above, above + line);
  }
  return true;
}

void LabelCounts::add_row(int row, const Lanes* above, Lanes* here) {
  const int vectors = running_.vectors();
  const int block_px = block_cells_ * cell_px_;
  const int right_px = cells_across_ * cell_px_;
  const int height = std::min(block_px, cells_down_ * cell_px_ - row * block_px);
  const std::uint16_t* labels = labels_at(0, row * block_cells_);
  running_.clear();
  std::fill_n(here, vectors, Lanes{});
  for (int x = 0; x < right_px; x += block_px) {
    count_pixels<1>(labels + x, label_stride_, std::min(block_px, right_px - x), height, running_.counts());
    above += vectors;
    here += vectors;
    const Lanes* add = running_.data();
    for (int v = 0; v < vectors; v += 4) {
      store(here[v], _mm_add_epi16(load(above[v]), load(add[v])));
      store(here[v + 1], _mm_add_epi16(load(above[v + 1]), load(add[v + 1])));
      store(here[v + 2], _mm_add_epi16(load(above[v + 2]), load(add[v + 2])));
      store(here[v + 3], _mm_add_epi16(load(above[v + 3]), load(add[v + 3])));
    }
  }
}

void LabelCounts::sum_blocks(const CellRect& blocks, LabelHistogram& histogram) const {
  const Lanes* a = corner(blocks.left, blocks.top);
  const Lanes* b = corner(blocks.right, blocks.top);
  const Lanes* c = corner(blocks.left, blocks.bottom);
  const Lanes* d = corner(blocks.right, blocks.bottom);
  Lanes* to = histogram.data();
  for (const Lanes* end = to + histogram.vectors(); to != end; to += 2, a += 2, b += 2, c += 2, d += 2) {
    store(to[0], _mm_sub_epi16(_mm_add_epi16(load(d[0]), load(a[0])), _mm_add_epi16(load(b[0]), load(c[0]))));
    store(to[1], _mm_sub_epi16(_mm_add_epi16(load(d[1]), load(a[1])), _mm_add_epi16(load(b[1]), load(c[1]))));
  }
}

void LabelCounts::cover(const CellRect& rect, LabelHistogram& histogram) const {
  const int cells = block_cells_;
  const int right = std::min((rect.right + cells - 1) / cells, columns_);
  const int bottom = std::min((rect.bottom + cells - 1) / cells, rows_);
  sum_blocks({rect.left / cells, rect.top / cells, right, bottom}, histogram);
}

long LabelCounts::covered_pixels(const CellRect& rect) const {
  const int cells = block_cells_;
  const long across = (rect.right + cells - 1) / cells - rect.left / cells;
  const long down = (rect.bottom + cells - 1) / cells - rect.top / cells;
  const long block_px = static_cast<long>(cells) * cell_px_;
  return across * down * block_px * block_px;
}

void LabelCounts::add_strip(const CellRect& cells, LabelHistogram& histogram) const {
  if (cells.left >= cells.right || cells.top >= cells.bottom) return;
  count_pixels<1>(labels_at(cells.left, cells.top), label_stride_, (cells.right - cells.left) * cell_px_,
                  (cells.bottom - cells.top) * cell_px_, histogram.counts());
}

void LabelCounts::take_strip(const CellRect& cells, LabelHistogram& histogram) const {
  if (cells.left >= cells.right || cells.top >= cells.bottom) return;
  count_pixels<-1>(labels_at(cells.left, cells.top), label_stride_, (cells.right - cells.left) * cell_px_,
                   (cells.bottom - cells.top) * cell_px_, histogram.counts());
}

void LabelCounts::exact(const CellRect& rect, LabelHistogram& histogram) const {
  const auto nearest = [this](int edge, int blocks) {
    return std::min((edge + block_cells_ / 2) / block_cells_, blocks);
  };
  const CellRect blocks{nearest(rect.left, columns_), nearest(rect.top, rows_), nearest(rect.right, columns_),
                        nearest(rect.bottom, rows_)};
  sum_blocks(blocks, histogram);

  // First left and right between the blocks' top and bottom, then above and below across the whole of `rect`.
  const CellRect near{
      std::min(blocks.left * block_cells_, cells_across_), std::min(blocks.top * block_cells_, cells_down_),
      std::min(blocks.right * block_cells_, cells_across_), std::min(blocks.bottom * block_cells_, cells_down_)};
  add_strip({rect.left, near.top, near.left, near.bottom}, histogram);
  take_strip({near.left, near.top, rect.left, near.bottom}, histogram);
  add_strip({near.right, near.top, rect.right, near.bottom}, histogram);
  take_strip({rect.right, near.top, near.right, near.bottom}, histogram);
  add_strip({rect.left, rect.top, rect.right, near.top}, histogram);
  take_strip({rect.left, near.top, rect.right, rect.top}, histogram);
  add_strip({rect.left, near.bottom, rect.right, rect.bottom}, histogram);
  take_strip({rect.left, rect.bottom, rect.right, near.bottom}, histogram);
}

}  // namespace cgsr::color
