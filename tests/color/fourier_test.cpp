#include "pipeline/color/track/fourier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/allocation_guard.h"

namespace cgsr::color {
namespace {

using Complexes = std::vector<std::complex<double>>;

std::size_t at(int x, int y) {
  return static_cast<std::size_t>(y * kGrid + x);
}

/// The definition, first along the rows, then along the columns, in double.
Complexes naive_transform(const RealGrid& grid) {
  const auto turn = [](int k, int n) { return std::polar(1.0, -2.0 * std::numbers::pi * (k * n % kGrid) / kGrid); };
  Complexes rows(kGridArea), all(kGridArea);
  for (int y = 0; y < kGrid; ++y) {
    for (int k = 0; k < kGrid; ++k) {
      for (int x = 0; x < kGrid; ++x) rows[at(k, y)] += static_cast<double>(grid[at(x, y)]) * turn(k, x);
    }
  }
  for (int x = 0; x < kGrid; ++x) {
    for (int k = 0; k < kGrid; ++k) {
      for (int y = 0; y < kGrid; ++y) all[at(x, k)] += rows[at(x, y)] * turn(k, y);
    }
  }
  return all;
}

double max_error(const Spectrum& spectrum, const Complexes& expected) {
  double error = 0.0;
  for (std::size_t i = 0; i < kGridArea; ++i) {
    const std::complex<double> value{static_cast<double>(spectrum.re[i]), static_cast<double>(spectrum.im[i])};
    error = std::max(error, std::abs(value - expected[i]));
  }
  return error;
}

RealGrid random_grid(std::mt19937& random, float scale) {
  std::uniform_real_distribution<float> value(-scale, scale);
  RealGrid grid;
  for (float& v : grid) v = value(random);
  return grid;
}

// Two grids in one pass must not leak into each other, even when one is a thousand times the other.
TEST(FourierProperty, IsTheDefinitionForBothGrids) {
  std::mt19937 random(31);
  for (int trial = 0; trial < 40; ++trial) {
    const float other_scale = trial % 3 == 0 ? 0.001F : 1.0F;
    const RealGrid a = random_grid(random, 1.0F);
    const RealGrid b = random_grid(random, other_scale);
    Spectrum spectrum_a, spectrum_b;

    transform(a, b, spectrum_a, spectrum_b);

    EXPECT_LT(max_error(spectrum_a, naive_transform(a)), 1e-4) << trial;
    EXPECT_LT(max_error(spectrum_b, naive_transform(b)), 1e-4) << trial;
  }
}

TEST(FourierProperty, TheInverseGivesBothGridsBack) {
  std::mt19937 random(32);
  for (int trial = 0; trial < 200; ++trial) {
    const RealGrid a = random_grid(random, 1.0F);
    const RealGrid b = random_grid(random, 1.0F);
    Spectrum spectrum_a, spectrum_b;
    transform(a, b, spectrum_a, spectrum_b);
    RealGrid back_a, back_b, pair_a, pair_b;

    inverse_transform(spectrum_a, spectrum_b, pair_a, pair_b);
    inverse_transform(spectrum_a, back_a);
    inverse_transform(spectrum_b, back_b);

    for (std::size_t i = 0; i < kGridArea; ++i) {
      ASSERT_NEAR(back_a[i], a[i], 1e-5) << trial;
      ASSERT_NEAR(back_b[i], b[i], 1e-5) << trial;
      ASSERT_NEAR(pair_a[i], a[i], 1e-5) << trial;
      ASSERT_NEAR(pair_b[i], b[i], 1e-5) << trial;
    }
  }
}

// What the correlation filter rests on: a shift of the grid is a turn of each frequency by exp(-2 pi i (kx dx + ky dy) / 32).
TEST(FourierProperty, AShiftTurnsEveryFrequency) {
  std::mt19937 random(33);
  for (int trial = 0; trial < 40; ++trial) {
    const int dx = static_cast<int>(random() % kGrid), dy = static_cast<int>(random() % kGrid);
    const RealGrid grid = random_grid(random, 1.0F);
    RealGrid shifted;
    for (int y = 0; y < kGrid; ++y) {
      for (int x = 0; x < kGrid; ++x) shifted[at((x + dx) % kGrid, (y + dy) % kGrid)] = grid[at(x, y)];
    }
    Spectrum spectrum, spectrum_shifted;

    transform(grid, shifted, spectrum, spectrum_shifted);

    Complexes expected(kGridArea);
    for (int ky = 0; ky < kGrid; ++ky) {
      for (int kx = 0; kx < kGrid; ++kx) {
        const std::complex<double> value{static_cast<double>(spectrum.re[at(kx, ky)]),
                                         static_cast<double>(spectrum.im[at(kx, ky)])};
        const double angle = -2.0 * std::numbers::pi * ((kx * dx + ky * dy) % kGrid) / kGrid;
        expected[at(kx, ky)] = value * std::polar(1.0, angle);
      }
    }
    EXPECT_LT(max_error(spectrum_shifted, expected), 2e-4) << dx << ',' << dy;
  }
}

TEST(FourierAlloc, Nothing) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  RealGrid grid{};
  Spectrum a, b;
  const test::AllocationGuard guard;
  transform(grid, grid, a, b);
  inverse_transform(a, grid);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::color
