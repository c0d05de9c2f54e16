#include "pipeline/color/distinctiveness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace cgsr::color {
namespace {

constexpr double kDark = 0.12;   // below: no hue
constexpr double kNoise = 0.02;  // added to each channel: keeps the logarithm of a channel near 0 from wandering
constexpr double kCell = 0.1;    // of the plane (ln R/G, ln B/G)
constexpr int kReach = 2;        // cells to either side: a square of 5 x 5 cells, half side 0.25
constexpr int kSide = 81;        // cells per axis, +-4: beyond any ratio that kNoise leaves
constexpr int kPadded = kSide + 1;

int cell_of(double log_ratio) {
  return std::clamp(static_cast<int>(std::lround(log_ratio / kCell)) + kSide / 2, 0, kSide - 1);
}

// Jensen-Shannon divergence between a distribution and its own part of mass m, renormalised.
double divergence_to_part(double m) {
  const double part = m > 0.0 ? m * std::log(2.0 * m / (1.0 + m)) : 0.0;
  return 0.5 * (std::log(2.0 / (1.0 + m)) + part + (1.0 - m) * std::numbers::ln2);
}

}  // namespace

Distinctiveness distinctiveness_of(std::span<const imaging::Rgb> textures) {
  if (textures.empty()) return {};
  std::array<std::array<int, kPadded>, kPadded> sums{};  // counts first, then a summed-area table
  int dark = 0;
  for (const auto& c : textures) {
    if (std::max({c.r, c.g, c.b}) < kDark) {
      ++dark;
      continue;
    }
    const int x = cell_of(std::log((c.r + kNoise) / (c.g + kNoise)));
    const int y = cell_of(std::log((c.b + kNoise) / (c.g + kNoise)));
    ++sums[static_cast<std::size_t>(y + 1)][static_cast<std::size_t>(x + 1)];
  }
  for (std::size_t y = 1; y < kPadded; ++y) {
    for (std::size_t x = 1; x < kPadded; ++x) sums[y][x] += sums[y - 1][x] + sums[y][x - 1] - sums[y - 1][x - 1];
  }

  int most = 0;
  for (int y = 0; y < kSide; ++y) {
    const auto top = static_cast<std::size_t>(std::max(0, y - kReach));
    const auto bottom = static_cast<std::size_t>(std::min(kSide, y + kReach + 1));
    for (int x = 0; x < kSide; ++x) {
      const auto left = static_cast<std::size_t>(std::max(0, x - kReach));
      const auto right = static_cast<std::size_t>(std::min(kSide, x + kReach + 1));
      most = std::max(most, sums[bottom][right] - sums[top][right] - sums[bottom][left] + sums[top][left]);
    }
  }
  const double m = static_cast<double>(most + dark) / static_cast<double>(textures.size());
  return {divergence_to_part(m), m};
}

}  // namespace cgsr::color
