#pragma once

#include <cmath>
#include <cstdint>

#include "tools/lab/scenes/random.h"

namespace cgsr::lab {

/// Smooth noise of the plane in [-1, 1]: random values on a grid, blended between its points.
/// \param cell  distance of the grid's points, in the unit of x and y.
inline double value_noise(double x, double y, double cell, std::uint64_t seed) {
  const auto at = [seed](double column, double row) {
    const auto c = static_cast<std::uint64_t>(static_cast<std::int64_t>(column));
    const auto r = static_cast<std::uint64_t>(static_cast<std::int64_t>(row));
    return static_cast<double>(Random::mix(Random::mix(seed ^ c * 0x9E3779B97F4A7C15ULL) ^ r) >> 11) * 0x1.0p-52 - 1.0;
  };
  const double column = std::floor(x / cell), row = std::floor(y / cell);
  const double fx = x / cell - column, fy = y / cell - row;
  const double sx = fx * fx * (3.0 - 2.0 * fx), sy = fy * fy * (3.0 - 2.0 * fy);
  const double top = at(column, row) + sx * (at(column + 1, row) - at(column, row));
  const double bottom = at(column, row + 1) + sx * (at(column + 1, row + 1) - at(column, row + 1));
  return top + sy * (bottom - top);
}

}  // namespace cgsr::lab
