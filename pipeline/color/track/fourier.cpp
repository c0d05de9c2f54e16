#include "pipeline/color/track/fourier.h"

#include <emmintrin.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace cgsr::imaging {
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

/// Cooley-Tukey, radix 2, decimation in time, down the columns: four neighbouring columns in a register.
void transform_columns(float* re, float* im) {
  for (int row = 0; row < kGrid; ++row) {
    const int other = reversed(row);
    if (other <= row) continue;
    for (int x = 0; x < kGrid; ++x) {
      std::swap(re[row * kGrid + x], re[other * kGrid + x]);
      std::swap(im[row * kGrid + x], im[other * kGrid + x]);
    }
  }
  for (int half = 1; half < kGrid; half *= 2) {
    for (int start = 0; start < kGrid; start += 2 * half) {
      for (int k = 0; k < half; ++k) {
        const auto twiddle = static_cast<std::size_t>(k * (kGrid / 2 / half));
        const __m128 wr = _mm_set1_ps(kTwiddles.re[twiddle]);
        const __m128 wi = _mm_set1_ps(kTwiddles.im[twiddle]);
        float* upper_re = re + (start + k) * kGrid;
        float* upper_im = im + (start + k) * kGrid;
        float* lower_re = upper_re + half * kGrid;
        float* lower_im = upper_im + half * kGrid;
        for (int x = 0; x < kGrid; x += 4) {
          const __m128 br = _mm_load_ps(lower_re + x);
          const __m128 bi = _mm_load_ps(lower_im + x);
          const __m128 tr = _mm_sub_ps(_mm_mul_ps(br, wr), _mm_mul_ps(bi, wi));
          const __m128 ti = _mm_add_ps(_mm_mul_ps(br, wi), _mm_mul_ps(bi, wr));
          const __m128 ar = _mm_load_ps(upper_re + x);
          const __m128 ai = _mm_load_ps(upper_im + x);
          _mm_store_ps(upper_re + x, _mm_add_ps(ar, tr));
          _mm_store_ps(upper_im + x, _mm_add_ps(ai, ti));
          _mm_store_ps(lower_re + x, _mm_sub_ps(ar, tr));
          _mm_store_ps(lower_im + x, _mm_sub_ps(ai, ti));
        }
      }
    }
  }
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

}  // namespace

void transform(const RealGrid& a, const RealGrid& b, Spectrum& spectrum_a, Spectrum& spectrum_b) {
  // Z is the spectrum of a + i b. Those of a and b are its parts that are even and odd under conjugation and k -> -k.
  Spectrum z;
  z.re = a;
  z.im = b;
  transform_both(z.re.data(), z.im.data());
  for (int y = 0; y < kGrid; ++y) {
    const int mirror_row = (kGrid - y) % kGrid * kGrid;
    for (int x = 0; x < kGrid; ++x) {
      const auto at = static_cast<std::size_t>(y * kGrid + x);
      const auto mirror = static_cast<std::size_t>(mirror_row + (kGrid - x) % kGrid);
      spectrum_a.re[at] = 0.5F * (z.re[at] + z.re[mirror]);
      spectrum_a.im[at] = 0.5F * (z.im[at] - z.im[mirror]);
      spectrum_b.re[at] = 0.5F * (z.im[at] + z.im[mirror]);
      spectrum_b.im[at] = 0.5F * (z.re[mirror] - z.re[at]);
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

}  // namespace cgsr::imaging
