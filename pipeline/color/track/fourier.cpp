#include "pipeline/color/track/fourier.h"

#include <emmintrin.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace cgsr::color {
namespace {

/// exp(-2 pi i k / 32), k = 0..15.
struct Twiddles {
  std::array<float, kGrid / 2> re;
  std::array<float, kGrid / 2> im;
  Twiddles() {
    for (int k = 0; k < kGrid / 2; ++k) {
      const double angle = -2.0 * std::numbers::pi * k / kGrid;
      re[static_cast<std::size_t>(k)] = static_cast<float>(std::cos(angle));
      im[static_cast<std::size_t>(k)] = static_cast<float>(std::sin(angle));
    }
  }
};
const Twiddles kTwiddles;

constexpr int reversed(int i) {
  return (i & 1) << 4 | (i & 2) << 2 | (i & 4) | (i & 8) >> 2 | (i & 16) >> 4;
}

/// Four neighbouring columns of one row.
struct Values {
  __m128 re;
  __m128 im;
};

Values operator+(const Values& a, const Values& b) {
  return {_mm_add_ps(a.re, b.re), _mm_add_ps(a.im, b.im)};
}

Values operator-(const Values& a, const Values& b) {
  return {_mm_sub_ps(a.re, b.re), _mm_sub_ps(a.im, b.im)};
}

Values operator*(const Values& a, const Values& b) {
  return {_mm_sub_ps(_mm_mul_ps(a.re, b.re), _mm_mul_ps(a.im, b.im)),
          _mm_add_ps(_mm_mul_ps(a.re, b.im), _mm_mul_ps(a.im, b.re))};
}

/// A grid of complex values, the parts apart.
struct Grid {
  float* re;
  float* im;
  [[nodiscard]] Values load(int at) const { return {_mm_load_ps(re + at), _mm_load_ps(im + at)}; }
  void store(int at, const Values& values) const {
    _mm_store_ps(re + at, values.re);
    _mm_store_ps(im + at, values.im);
  }
};

Values twiddle(int k) {
  const auto i = static_cast<std::size_t>(k);
  return {_mm_set1_ps(kTwiddles.re[i]), _mm_set1_ps(kTwiddles.im[i])};
}

/// -i (a - b).
Values quarter_turn(const Values& a, const Values& b) {
  return {_mm_sub_ps(a.im, b.im), _mm_sub_ps(b.re, a.re)};
}

/// The stages with half a butterfly of 1 and 2 rows: all their twiddles are 1 or -i.
void first_two_stages(const Grid& grid) {
  for (int start = 0; start < kGridArea; start += 4 * kGrid) {
    for (int at = start; at < start + kGrid; at += 4) {
      const Values a = grid.load(at), b = grid.load(at + kGrid);
      const Values c = grid.load(at + 2 * kGrid), d = grid.load(at + 3 * kGrid);
      const Values even = a + b, odd = a - b, sum = c + d, turned = quarter_turn(c, d);
      grid.store(at, even + sum);
      grid.store(at + kGrid, odd + turned);
      grid.store(at + 2 * kGrid, even - sum);
      grid.store(at + 3 * kGrid, odd - turned);
    }
  }
}

/// Those of 4 and 8 rows, in one pass over the grid.
void middle_two_stages(const Grid& grid) {
  constexpr int kHalf = 4;
  constexpr int kStep = kHalf * kGrid;
  for (int start = 0; start < kGrid; start += 4 * kHalf) {
    for (int k = 0; k < kHalf; ++k) {
      const Values inner = twiddle(k * (kGrid / 2 / kHalf));
      const Values outer = twiddle(k * (kGrid / 4 / kHalf));
      const int row = (start + k) * kGrid;
      for (int at = row; at < row + kGrid; at += 4) {
        const Values a = grid.load(at), b = grid.load(at + kStep) * inner;
        const Values c = grid.load(at + 2 * kStep), d = grid.load(at + 3 * kStep) * inner;
        const Values even = a + b, odd = a - b, sum = (c + d) * outer, turned = quarter_turn(c, d) * outer;
        grid.store(at, even + sum);
        grid.store(at + kStep, odd + turned);
        grid.store(at + 2 * kStep, even - sum);
        grid.store(at + 3 * kStep, odd - turned);
      }
    }
  }
}

void last_stage(const Grid& grid) {
  constexpr int kStep = kGridArea / 2;
  for (int k = 0; k < kGrid / 2; ++k) {
    const Values turn = twiddle(k);
    for (int at = k * kGrid; at < (k + 1) * kGrid; at += 4) {
      const Values a = grid.load(at), b = grid.load(at + kStep) * turn;
      grid.store(at, a + b);
      grid.store(at + kStep, a - b);
    }
  }
}

/// Cooley-Tukey, radix 2, decimation in time, down the columns: four neighbouring columns in a register, two stages in a pass.
void transform_columns(float* re, float* im) {
  for (int row = 0; row < kGrid; ++row) {
    const int other = reversed(row);
    if (other <= row) continue;
    for (int x = 0; x < kGrid; ++x) {
      std::swap(re[row * kGrid + x], re[other * kGrid + x]);
      std::swap(im[row * kGrid + x], im[other * kGrid + x]);
    }
  }
  const Grid grid{re, im};
  first_two_stages(grid);
  middle_two_stages(grid);
  last_stage(grid);
}

void transpose(float* grid) {
  for (int y = 0; y < kGrid; y += 4) {
    for (int x = y; x < kGrid; x += 4) {
      const auto load = [grid](int row, int column, int i) { return _mm_load_ps(grid + (row + i) * kGrid + column); };
      __m128 a0 = load(y, x, 0), a1 = load(y, x, 1), a2 = load(y, x, 2), a3 = load(y, x, 3);
      __m128 b0 = load(x, y, 0), b1 = load(x, y, 1), b2 = load(x, y, 2), b3 = load(x, y, 3);
      _MM_TRANSPOSE4_PS(a0, a1, a2, a3);
      _MM_TRANSPOSE4_PS(b0, b1, b2, b3);
      const auto store = [grid](int row, int column, int i, __m128 v) {
        _mm_store_ps(grid + (row + i) * kGrid + column, v);
      };
      store(x, y, 0, a0), store(x, y, 1, a1), store(x, y, 2, a2), store(x, y, 3, a3);
      store(y, x, 0, b0), store(y, x, 1, b1), store(y, x, 2, b2), store(y, x, 3, b3);
    }
  }
}

void transform_both(float* re, float* im) {
  transform_columns(re, im);
  transpose(re);
  transpose(im);
  transform_columns(re, im);
  transpose(re);
  transpose(im);
}

/// A row's values at the negative frequencies, so that they can be computed with as vectors.
struct MirrorRow {
  std::array<float, kGrid> values;
  MirrorRow(const RealGrid& grid, int row) {
    const float* mirror = grid.data() + (kGrid - row) % kGrid * kGrid;
    values[0] = mirror[0];
    std::reverse_copy(mirror + 1, mirror + kGrid, values.begin() + 1);
  }
};

}  // namespace

void transform(const RealGrid& a, const RealGrid& b, Spectrum& spectrum_a, Spectrum& spectrum_b) {
  // Z is the spectrum of a + i b. Those of a and b are its parts that are even and odd under conjugation and k -> -k.
  Spectrum z;
  z.re = a;
  z.im = b;
  transform_both(z.re.data(), z.im.data());
  for (int y = 0; y < kGrid; ++y) {
    const auto row = static_cast<std::size_t>(y * kGrid);
    const MirrorRow re(z.re, y);
    const MirrorRow im(z.im, y);
    for (std::size_t x = 0; x < kGrid; ++x) {
      spectrum_a.re[row + x] = 0.5F * (z.re[row + x] + re.values[x]);
      spectrum_a.im[row + x] = 0.5F * (z.im[row + x] - im.values[x]);
      spectrum_b.re[row + x] = 0.5F * (z.im[row + x] + im.values[x]);
      spectrum_b.im[row + x] = 0.5F * (re.values[x] - z.re[row + x]);
    }
  }
}

void inverse_transform(Spectrum& spectrum, RealGrid& grid) {
  // The inverse is the forward transform with the parts exchanged, twice.
  transform_both(spectrum.im.data(), spectrum.re.data());
  for (std::size_t i = 0; i < grid.size(); ++i) grid[i] = spectrum.re[i] * (1.0F / kGridArea);
}

void inverse_transform(const Spectrum& spectrum_a, const Spectrum& spectrum_b, RealGrid& a, RealGrid& b) {
  Spectrum z;  // of a + i b
  for (std::size_t i = 0; i < a.size(); ++i) {
    z.re[i] = spectrum_a.re[i] - spectrum_b.im[i];
    z.im[i] = spectrum_a.im[i] + spectrum_b.re[i];
  }
  transform_both(z.im.data(), z.re.data());
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = z.re[i] * (1.0F / kGridArea);
    b[i] = z.im[i] * (1.0F / kGridArea);
  }
}

}  // namespace cgsr::color
