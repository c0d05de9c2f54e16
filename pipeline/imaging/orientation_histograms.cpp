#include "pipeline/imaging/orientation_histograms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace cgsr::imaging {
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
  static int step(int gradient) { return (std::clamp(gradient, -kSteepest, kSteepest) + kSteepest + 1) >> 1; }
  std::vector<Votes> votes_;
};

const VoteTable& vote_table() {
  static const VoteTable table;
  return table;
}

/// Cells with a border of one on each side, so that votes past the edge need no test; orientations of a cell lie together.
struct Cells {
  static constexpr int kStride = kOrientations;
  std::array<float, static_cast<std::size_t>(34) * 34 * kStride> values;
  int width;
  int height;

  Cells(int cells_x, int cells_y) : width(cells_x), height(cells_y) {
    std::fill_n(values.begin(), static_cast<std::size_t>(width + 2) * static_cast<std::size_t>(height + 2) * kStride,
                0.0F);
  }
  float* at(int x, int y) {
    return values.data() + static_cast<std::ptrdiff_t>((y + 1) * (width + 2) + x + 1) * kStride;
  }
};

void vote(std::span<const std::uint8_t> luma, PatchSize size, int cell_px, Cells& cells) {
  const VoteTable& table = vote_table();
  const int width = size.width_px;
  const int height = size.height_px;
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* row = luma.data() + static_cast<std::ptrdiff_t>(y) * width;
    const std::uint8_t* above = y > 0 ? row - width : row;
    const std::uint8_t* below = y < height - 1 ? row + width : row;
    const float position_y = (static_cast<float>(y) + 0.5F) / static_cast<float>(cell_px) - 0.5F;
    const int cell_y = static_cast<int>(std::floor(position_y));
    const float lower = position_y - static_cast<float>(cell_y);
    for (int x = 0; x < width; ++x) {
      const int gx = row[std::min(width - 1, x + 1)] - row[std::max(0, x - 1)];
      const int gy = below[x] - above[x];
      if (gx == 0 && gy == 0) continue;
      const Votes& votes = table.of(gx, gy);
      // (x + 0.5) / cell - 0.5, in halves of the cell: which cell is left of the pixel, and how far to the right of its centre
      const int doubled = 2 * x + 1 - cell_px;
      const int cell_x = doubled < 0 ? -1 : doubled / (2 * cell_px);
      const float right = static_cast<float>(doubled - cell_x * 2 * cell_px) / static_cast<float>(2 * cell_px);
      float* top_left = cells.at(cell_x, cell_y);
      float* bottom_left = cells.at(cell_x, cell_y + 1);
      const auto add = [&votes](float* cell, float weight) {
        cell[votes.first] += weight * votes.first_weight;
        cell[votes.second] += weight * votes.second_weight;
      };
      add(top_left, (1.0F - right) * (1.0F - lower));
      add(top_left + Cells::kStride, right * (1.0F - lower));
      add(bottom_left, (1.0F - right) * lower);
      add(bottom_left + Cells::kStride, right * lower);
    }
  }
}

}  // namespace

void orientation_histograms(std::span<const std::uint8_t> luma, PatchSize size, int cell_px, std::span<float> out) {
  const int width = size.width_px / cell_px;
  const int height = size.height_px / cell_px;
  Cells cells(width, height);
  vote(luma, size, cell_px, cells);

  std::array<float, kMostCells> energy;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float* cell = cells.at(x, y);
      float sum = 0.0F;
      for (int b = 0; b < kOrientations; ++b) sum += cell[b] * cell[b];
      energy[static_cast<std::size_t>(y * width + x)] = sum;
    }
  }

  // A block is 2x2 cells; blocks are named by their top left cell and cut off at the border.
  const float floor_energy = 1.25F * static_cast<float>(cell_px * cell_px);  // flat patches stay flat
  std::array<float, kMostCells> inverse_norm;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int right = std::min(width - 1, x + 1);
      const int below = std::min(height - 1, y + 1);
      const auto at = [&](int i, int j) { return energy[static_cast<std::size_t>(j * width + i)]; };
      inverse_norm[static_cast<std::size_t>(y * width + x)] =
          1.0F / std::sqrt(at(x, y) + at(right, y) + at(x, below) + at(right, below) + floor_energy);
    }
  }
  const auto plane = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float* cell = cells.at(x, y);
      const int left = std::max(0, x - 1);
      const int above = std::max(0, y - 1);
      const auto at = [&](int i, int j) { return inverse_norm[static_cast<std::size_t>(j * width + i)]; };
      const float norms[4] = {at(x, y), at(left, y), at(x, above), at(left, above)};
      for (int b = 0; b < kOrientations; ++b) {
        float sum = 0.0F;
        for (const float norm : norms) sum += std::min(kClip, cell[b] * norm);
        out[static_cast<std::size_t>(b) * plane + static_cast<std::size_t>(y * width + x)] = 0.5F * sum;
      }
    }
  }
}

}  // namespace cgsr::imaging
