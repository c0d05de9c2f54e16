#include "pipeline/color/track/orientation_histograms.h"

#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace cgsr::color {
namespace {

constexpr int kSteepest = 128;         // steeper gradients, which are rare, count as this
constexpr int kSteps = kSteepest + 1;  // of either gradient component from -kSteepest on, each 2 grey levels wide
constexpr float kClip = 0.2F;

/// What a pixel with a given gradient adds to the histogram: two neighbouring orientations and their weights.
struct Votes {
  float first_weight;
  float second_weight;
  std::int32_t first;
  std::int32_t second;
};

/// Votes by gradient, in steps of 2 grey levels of either component.
class VoteTable {
 public:
  VoteTable() : votes_(static_cast<std::size_t>(kSteps) * kSteps) {
    for (int gradient = -255; gradient <= 255; ++gradient) {
      const int limited = std::clamp(gradient, -kSteepest, kSteepest);
      // Odd ones away from zero, either way: the negative of an image has the same orientations.
      const int steps = limited < 0 ? -((1 - limited) / 2) : (limited + 1) / 2;
      steps_[static_cast<std::size_t>(gradient + 255)] = static_cast<std::int16_t>(steps + kSteepest / 2);
    }
    for (int j = 0; j < kSteps; ++j) {
      for (int i = 0; i < kSteps; ++i) {
        const double gx = 2.0 * i - kSteepest;
        const double gy = 2.0 * j - kSteepest;
        double angle = std::atan2(gy, gx);
        if (angle < 0.0) angle += std::numbers::pi;
        const double position = angle * kOrientations / std::numbers::pi;
        const int bin = static_cast<int>(position);
        const double magnitude = std::hypot(gx, gy);
        const double second = position - bin;
        votes_[static_cast<std::size_t>(j * kSteps + i)] = {static_cast<float>(magnitude * (1.0 - second)),
                                                            static_cast<float>(magnitude * second), bin % kOrientations,
                                                            (bin + 1) % kOrientations};
      }
    }
  }
  [[nodiscard]] const Votes& of(int gx, int gy) const {
    return votes_[static_cast<std::size_t>(step(gy) * kSteps + step(gx))];
  }

 private:
  [[nodiscard]] int step(int gradient) const { return steps_[static_cast<std::size_t>(gradient + 255)]; }
  std::array<std::int16_t, 511> steps_{};
  std::vector<Votes> votes_;
};

const VoteTable& vote_table() {
  static const VoteTable table;
  return table;
}

/// Cells with a border of one on each side, so that votes past the edge need no test. A row of cells is one orientation after the other, so that the two
/// cells beside a pixel lie together.
struct Cells {
  std::array<float, static_cast<std::size_t>(34) * 34 * kOrientations> values;
  int width;
  int height;

  Cells(int cells_x, int cells_y) : width(cells_x), height(cells_y) {
    std::fill_n(values.begin(), static_cast<std::size_t>(row_length()) * static_cast<std::size_t>(height + 2), 0.0F);
  }
  [[nodiscard]] int row_length() const { return (width + 2) * kOrientations; }
  float* row(int y) { return values.data() + static_cast<std::ptrdiff_t>(y + 1) * row_length(); }
  float* row(int y, int orientation) { return row(y) + static_cast<std::ptrdiff_t>(orientation) * (width + 2) + 1; }
};

/// One row of pixels: each votes for the two cells beside it, linearly in x. `row_cells` has a cell more on either side.
class RowVotes {
 public:
  RowVotes(int width_px, int cell_px, const VoteTable& table)
      : width_(width_px), cells_(width_px / cell_px + 2), table_(table) {
    for (int x = 0; x < width_px; ++x) {
      // (x + 0.5) / cell - 0.5: which cell's centre is left of the pixel, and how far it is from there
      const int doubled = 2 * x + 1 - cell_px;
      const int cell = doubled < 0 ? -1 : doubled / (2 * cell_px);
      const auto right = static_cast<float>(doubled - cell * 2 * cell_px) / static_cast<float>(2 * cell_px);
      places_[static_cast<std::size_t>(x)] = {cell + 1, {1.0F - right, right}};
    }
  }

  void cast(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, float* row_cells) const {
    vote(0, row[1] - row[0], below[0] - above[0], row_cells);
    for (int x = 1; x < width_ - 1; ++x) vote(x, row[x + 1] - row[x - 1], below[x] - above[x], row_cells);
    const int last = width_ - 1;
    vote(last, row[last] - row[last - 1], below[last] - above[last], row_cells);
  }

 private:
  struct Place {
    std::int32_t left;            ///< the cell to the left of the pixel,
    std::array<float, 2> shares;  ///< and the shares of this and the next.
  };

  void vote(int x, int gx, int gy, float* row_cells) const {
    if ((gx | gy) == 0) return;
    const Votes& votes = table_.of(gx, gy);
    const Place& place = places_[static_cast<std::size_t>(x)];
    const __m128 shares = pair(place.shares.data());
    float* first = row_cells + place.left + votes.first * cells_;
    float* second = row_cells + place.left + votes.second * cells_;
    const __m128 first_votes = _mm_mul_ps(shares, _mm_set1_ps(votes.first_weight));
    const __m128 second_votes = _mm_mul_ps(shares, _mm_set1_ps(votes.second_weight));
    store_pair(first, _mm_add_ps(pair(first), first_votes));
    store_pair(second, _mm_add_ps(pair(second), second_votes));
  }

  static __m128 pair(const float* from) {
    return _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from)));
  }
  static void store_pair(float* to, __m128 values) {
    _mm_storel_epi64(reinterpret_cast<__m128i*>(to), _mm_castps_si128(values));
  }

  int width_;
  int cells_;  ///< of a row with its border.
  const VoteTable& table_;
  std::array<Place, 64> places_;
};

void vote(std::span<const std::uint8_t> luma, imaging::PatchSize size, int cell_px, Cells& cells) {
  const RowVotes votes(size.width_px, cell_px, vote_table());
  std::array<float, std::size_t{34} * kOrientations> row_cells;
  const auto row_length = static_cast<std::size_t>(cells.row_length());
  for (int y = 0; y < size.height_px; ++y) {
    const std::uint8_t* row = luma.data() + static_cast<std::ptrdiff_t>(y) * size.width_px;
    std::fill_n(row_cells.begin(), row_length, 0.0F);
    votes.cast(y > 0 ? row - size.width_px : row, row, y < size.height_px - 1 ? row + size.width_px : row,
               row_cells.data());
    // The same in y, a whole row at a time.
    const int doubled = 2 * y + 1 - cell_px;
    const int cell_y = doubled < 0 ? -1 : doubled / (2 * cell_px);
    const auto lower = static_cast<float>(doubled - cell_y * 2 * cell_px) / static_cast<float>(2 * cell_px);
    float* top = cells.row(cell_y);
    float* bottom = cells.row(cell_y + 1);
    for (std::size_t i = 0; i < row_length; ++i) {
      top[i] += (1.0F - lower) * row_cells[i];
      bottom[i] += lower * row_cells[i];
    }
  }
}

/// Values per cell with the border's repeated once around, so that every cell has neighbours.
class BorderedPlane {
 public:
  BorderedPlane(int width, int height) : width_(width), height_(height) {}
  float* row(int y) { return values_.data() + static_cast<std::ptrdiff_t>(y + 1) * kStride + 1; }
  void repeat_border() {
    for (int y = 0; y < height_; ++y) {
      row(y)[-1] = row(y)[0];
      row(y)[width_] = row(y)[width_ - 1];
    }
    std::copy_n(row(0) - 1, width_ + 2, row(-1) - 1);
    std::copy_n(row(height_ - 1) - 1, width_ + 2, row(height_) - 1);
  }

 private:
  static constexpr int kStride = 34;
  std::array<float, std::size_t{kStride} * kStride> values_;
  int width_;
  int height_;
};

/// The four blocks around a cell, a block being 2x2 cells: \return 1 / norm of each, named by its top left cell.
void inverse_norms(BorderedPlane& energy, float floor_energy, int width, int height, BorderedPlane& inverse) {
  energy.repeat_border();
  for (int y = 0; y < height; ++y) {
    const float* here = energy.row(y);
    const float* below = energy.row(y + 1);
    float* out = inverse.row(y);
    for (int x = 0; x < width; ++x) {
      out[x] = 1.0F / std::sqrt(here[x] + here[x + 1] + below[x] + below[x + 1] + floor_energy);
    }
  }
  inverse.repeat_border();
}

/// The sum of a row's values under the norms of the four blocks they lie in, each cut off. `values` becomes the sum.
void normalise(const float* norms_above, const float* norms_here, int width, float* values) {
  const auto clipped = [](float value) { return value < kClip ? value : kClip; };
  for (int x = 0; x < width; ++x) {
    const float value = values[x];
    values[x] = 0.5F * (clipped(value * norms_here[x]) + clipped(value * norms_here[x - 1]) +
                        clipped(value * norms_above[x]) + clipped(value * norms_above[x - 1]));
  }
}

}  // namespace

void orientation_histograms(std::span<const std::uint8_t> luma, imaging::PatchSize size, int cell_px,
                            std::span<float> out) {
  const int width = size.width_px / cell_px;
  const int height = size.height_px / cell_px;
  Cells cells(width, height);
  vote(luma, size, cell_px, cells);

  const std::ptrdiff_t plane = static_cast<std::ptrdiff_t>(width) * height;
  BorderedPlane energy(width, height);
  for (int y = 0; y < height; ++y) {
    float* row_energy = energy.row(y);
    std::fill_n(row_energy, width, 0.0F);
    for (int b = 0; b < kOrientations; ++b) {
      const float* from = cells.row(y, b);
      float* to = out.data() + b * plane + static_cast<std::ptrdiff_t>(y) * width;
      std::copy_n(from, width, to);
      for (int x = 0; x < width; ++x) row_energy[x] += from[x] * from[x];
    }
  }
  const float floor_energy = 1.25F * static_cast<float>(cell_px * cell_px);  // flat patches stay flat
  BorderedPlane inverse(width, height);
  inverse_norms(energy, floor_energy, width, height, inverse);
  for (int b = 0; b < kOrientations; ++b) {
    for (int y = 0; y < height; ++y) {
      float* values = out.data() + b * plane + static_cast<std::ptrdiff_t>(y) * width;
      normalise(inverse.row(y - 1), inverse.row(y), width, values);
    }
  }
}

}  // namespace cgsr::color
