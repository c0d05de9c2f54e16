#include "pipeline/imaging/pyramid.h"

#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

namespace cgsr::imaging {
namespace {

constexpr int kLongestPatchSide_px = 256;
constexpr int kCoarsestSide_px = 8;
constexpr int kLongestBlend_px = 512;

/// Mean of each 2x2 block of a byte plane, rounded half up. An odd last row or column is left out.
void halve(const Plane& from, std::uint8_t* to, int width, int height) {
  const __m128i low = _mm_set1_epi16(0x00ff);
  const __m128i two = _mm_set1_epi16(2);
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* a = from.data + 2 * y * from.stride_bytes;
    const std::uint8_t* b = a + from.stride_bytes;
    std::uint8_t* out = to + static_cast<std::ptrdiff_t>(y) * width;
    int x = 0;
    for (; x + 8 <= width; x += 8) {
      const __m128i top = _mm_loadu_si128(reinterpret_cast<const __m128i*>(a + 2 * x));
      const __m128i bottom = _mm_loadu_si128(reinterpret_cast<const __m128i*>(b + 2 * x));
      const __m128i top_sum = _mm_add_epi16(_mm_and_si128(top, low), _mm_srli_epi16(top, 8));
      const __m128i bottom_sum = _mm_add_epi16(_mm_and_si128(bottom, low), _mm_srli_epi16(bottom, 8));
      const __m128i mean = _mm_srli_epi16(_mm_add_epi16(_mm_add_epi16(top_sum, bottom_sum), two), 2);
      _mm_storel_epi64(reinterpret_cast<__m128i*>(out + x), _mm_packus_epi16(mean, mean));
    }
    for (; x < width; ++x)
      out[x] = static_cast<std::uint8_t>((a[2 * x] + a[2 * x + 1] + b[2 * x] + b[2 * x + 1] + 2) / 4);
  }
}

/// Level 1 of a YUYV image: luma as 2x2 means, chroma as means of two rows.
void halve_yuyv(const ImageView& image, std::uint8_t* y_out, std::uint8_t* u_out, std::uint8_t* v_out, int width,
                int height) {
  const __m128i low = _mm_set1_epi16(0x00ff);
  const __m128i ones = _mm_set1_epi16(1);
  const __m128i two = _mm_set1_epi32(2);
  const __m128i word = _mm_set1_epi32(0xffff);
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* a = image.row(2 * y);
    const std::uint8_t* b = image.row(2 * y + 1);
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(y) * width;
    int x = 0;
    for (; x + 8 <= width; x += 8) {  // two times 16 bytes, Y0 U0 Y1 V0 ..., are eight pixels of level 1
      __m128i mean[2];
      __m128i chroma[2];
      for (int half = 0; half < 2; ++half) {
        const __m128i top = _mm_loadu_si128(reinterpret_cast<const __m128i*>(a + 4 * x + 16 * half));
        const __m128i bottom = _mm_loadu_si128(reinterpret_cast<const __m128i*>(b + 4 * x + 16 * half));
        const __m128i luma = _mm_add_epi16(_mm_and_si128(top, low), _mm_and_si128(bottom, low));
        mean[half] = _mm_srli_epi32(_mm_add_epi32(_mm_madd_epi16(luma, ones), two), 2);
        chroma[half] = _mm_avg_epu16(_mm_srli_epi16(top, 8), _mm_srli_epi16(bottom, 8));  // U V U V ...
      }
      const auto store = [x, at](std::uint8_t* out, __m128i words) {
        _mm_storel_epi64(reinterpret_cast<__m128i*>(out + at + x), _mm_packus_epi16(words, words));
      };
      store(y_out, _mm_packs_epi32(mean[0], mean[1]));
      store(u_out, _mm_packs_epi32(_mm_and_si128(chroma[0], word), _mm_and_si128(chroma[1], word)));
      store(v_out, _mm_packs_epi32(_mm_srli_epi32(chroma[0], 16), _mm_srli_epi32(chroma[1], 16)));
    }
    for (; x < width; ++x) {
      const std::uint8_t* p = a + 4 * x;
      const std::uint8_t* q = b + 4 * x;
      y_out[at + x] = static_cast<std::uint8_t>((p[0] + p[2] + q[0] + q[2] + 2) / 4);
      u_out[at + x] = static_cast<std::uint8_t>((p[1] + q[1] + 1) / 2);
      v_out[at + x] = static_cast<std::uint8_t>((p[3] + q[3] + 1) / 2);
    }
  }
}

/// Where one column (or row) of a patch falls in a plane: its left neighbour, and the right one's weight in 1/128, 0 at the border.
struct Taps {
  std::array<std::int32_t, kLongestPatchSide_px> first;
  std::array<std::int16_t, kLongestPatchSide_px> weight;
};

/// Fills the taps of `count` samples at origin, origin + step, ... in 1/2^16 pixels; what lies outside takes the border's value.
void fill_taps(double origin, double step, int count, int length, Taps& taps) {
  constexpr double kOne = 65536.0;
  const auto limited = [](double value) { return static_cast<std::int64_t>(std::clamp(value, -1e6, 1e6) * kOne); };
  std::int64_t position = limited(origin + 0.5 * step - 0.5);
  const std::int64_t advance = limited(step);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i, position += advance) {
    const std::int64_t left = position >> 16;
    const bool inside = left >= 0 && left < length - 1;
    taps.first[i] = static_cast<std::int32_t>(std::clamp<std::int64_t>(left, 0, length - 1));
    taps.weight[i] = inside ? static_cast<std::int16_t>((position & 0xffff) >> 9) : std::int16_t{0};
  }
}

/// Blends `count` pixels of two rows, a + (b - a) weight / 128, into 16-bit values scaled by 128. Reads up to 15 bytes past the last.
void blend_rows(const std::uint8_t* a, const std::uint8_t* b, int weight, int pixel_stride, int count,
                std::int16_t* out) {
  const __m128i zero = _mm_setzero_si128();
  const __m128i low = _mm_set1_epi16(0x00ff);
  const __m128i wb = _mm_set1_epi16(static_cast<short>(weight));
  const __m128i wa = _mm_set1_epi16(static_cast<short>(128 - weight));
  const auto blend = [&](__m128i top, __m128i bottom) {
    return _mm_add_epi16(_mm_mullo_epi16(top, wa), _mm_mullo_epi16(bottom, wb));
  };
  const auto load = [](const std::uint8_t* p) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p)); };
  int i = 0;
  if (pixel_stride == 2) {
    for (; i + 8 <= count - 1; i += 8) {  // the last load must not pass the end of the row
      const __m128i blended = blend(_mm_and_si128(load(a + 2 * i), low), _mm_and_si128(load(b + 2 * i), low));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(out + i), blended);
    }
  } else {
    for (; i + 16 <= count; i += 16) {
      const __m128i top = load(a + i);
      const __m128i bottom = load(b + i);
      _mm_storeu_si128(reinterpret_cast<__m128i*>(out + i),
                       blend(_mm_unpacklo_epi8(top, zero), _mm_unpacklo_epi8(bottom, zero)));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(out + i + 8),
                       blend(_mm_unpackhi_epi8(top, zero), _mm_unpackhi_epi8(bottom, zero)));
    }
  }
  for (; i < count; ++i) {
    out[i] = static_cast<std::int16_t>(a[i * pixel_stride] * (128 - weight) + b[i * pixel_stride] * weight);
  }
}

/// Blends neighbours along a blended row and rounds to bytes. \param first  of each pixel, from the row's start.
void blend_columns(const std::int16_t* row, const Taps& taps, int origin, int count, std::uint8_t* out) {
  const __m128i one = _mm_set1_epi16(128);
  const __m128i half = _mm_set1_epi32(8192);
  const auto pair = [&](int i) {  // a pixel and its right neighbour
    std::int32_t both = 0;
    std::memcpy(&both, row + taps.first[static_cast<std::size_t>(i)] - origin, sizeof(both));
    return _mm_cvtsi32_si128(both);
  };
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    const __m128i pixels =
        _mm_unpacklo_epi64(_mm_unpacklo_epi32(pair(i), pair(i + 1)), _mm_unpacklo_epi32(pair(i + 2), pair(i + 3)));
    const __m128i right = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(taps.weight.data() + i));
    const __m128i weights = _mm_unpacklo_epi16(_mm_sub_epi16(one, right), right);
    const __m128i sums = _mm_srai_epi32(_mm_add_epi32(_mm_madd_epi16(pixels, weights), half), 14);
    const __m128i words = _mm_packs_epi32(sums, sums);
    const std::int32_t bytes = _mm_cvtsi128_si32(_mm_packus_epi16(words, words));
    std::memcpy(out + i, &bytes, sizeof(bytes));
  }
  for (; i < count; ++i) {
    const std::int16_t* left = row + taps.first[static_cast<std::size_t>(i)] - origin;
    const int weight = taps.weight[static_cast<std::size_t>(i)];
    out[i] = static_cast<std::uint8_t>((left[0] * (128 - weight) + left[1] * weight + 8192) >> 14);
  }
}

/// For a region so large that even the coarsest level has more pixels in a row than are blended at once: the nearest pixels.
void pick_nearest(const Plane& plane, const Taps& columns, const Taps& rows, PatchSize size, std::uint8_t* out) {
  for (std::size_t j = 0; j < static_cast<std::size_t>(size.height_px); ++j) {
    const std::uint8_t* row = plane.data + rows.first[j] * plane.stride_bytes;
    for (std::size_t i = 0; i < static_cast<std::size_t>(size.width_px); ++i) {
      *out++ = row[static_cast<std::ptrdiff_t>(columns.first[i]) * plane.pixel_stride];
    }
  }
}

void resample(const Plane& plane, const Box& region, double scale, PatchSize size, std::span<std::uint8_t> out) {
  assert(size.width_px <= kLongestPatchSide_px && size.height_px <= kLongestPatchSide_px && out.size() >= size.area());
  Taps columns;
  Taps rows;
  fill_taps(region.x * scale, region.width * scale / size.width_px, size.width_px, plane.width_px, columns);
  fill_taps(region.y * scale, region.height * scale / size.height_px, size.height_px, plane.height_px, rows);
  const int origin = columns.first[0];
  const int used = std::min(columns.first[static_cast<std::size_t>(size.width_px - 1)] + 2, plane.width_px) - origin;
  if (used > kLongestBlend_px) return pick_nearest(plane, columns, rows, size, out.data());

  std::array<std::int16_t, kLongestBlend_px + 2> blended{};  // the pixel behind the last is read, at weight 0
  for (int j = 0; j < size.height_px; ++j) {
    const auto row = static_cast<std::size_t>(j);
    const std::uint8_t* a =
        plane.data + rows.first[row] * plane.stride_bytes + static_cast<std::ptrdiff_t>(origin) * plane.pixel_stride;
    const std::uint8_t* b = rows.weight[row] > 0 ? a + plane.stride_bytes : a;
    blend_rows(a, b, rows.weight[row], plane.pixel_stride, used, blended.data());
    blend_columns(blended.data(), columns, origin, size.width_px,
                  out.data() + static_cast<std::ptrdiff_t>(j) * size.width_px);
  }
}

Plane plane_of(const std::vector<std::uint8_t>& bytes, int width, int height) {
  return {bytes.data(), width, height, width, 1};
}

}  // namespace

Pyramid::Pyramid(int max_width_px, int max_height_px) {
  int width = max_width_px;
  int height = max_height_px;
  for (int level = 1; level < kLevels; ++level) {
    width /= 2;
    height /= 2;
    const std::size_t area = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    storage_[level].y.resize(area);
    storage_[level].u.resize(area);
    storage_[level].v.resize(area);
  }
}

void Pyramid::build(const ImageView& image) {
  ++builds_;
  luma_[0] = {image.data, image.width_px, image.height_px, image.stride_bytes, 2};
  int width = image.width_px / 2;
  int height = image.height_px / 2;
  halve_yuyv(image, storage_[1].y.data(), storage_[1].u.data(), storage_[1].v.data(), width, height);
  luma_[1] = plane_of(storage_[1].y, width, height);
  u_[1] = plane_of(storage_[1].u, width, height);
  v_[1] = plane_of(storage_[1].v, width, height);
  levels_ = 2;
  while (levels_ < kLevels && width / 2 >= kCoarsestSide_px && height / 2 >= kCoarsestSide_px) {
    width /= 2;
    height /= 2;
    Storage& to = storage_[levels_];
    halve(luma_[levels_ - 1], to.y.data(), width, height);
    halve(u_[levels_ - 1], to.u.data(), width, height);
    halve(v_[levels_ - 1], to.v.data(), width, height);
    luma_[levels_] = plane_of(to.y, width, height);
    u_[levels_] = plane_of(to.u, width, height);
    v_[levels_] = plane_of(to.v, width, height);
    ++levels_;
  }
}

int Pyramid::level_for(const Box& region, PatchSize size) const {
  double step = std::min(region.width / size.width_px, region.height / size.height_px);
  int level = 0;
  while (step >= 1.5 && level + 1 < levels_) {
    step /= 2.0;
    ++level;
  }
  return level;
}

void Pyramid::sample_luma(const Box& region, PatchSize size, std::span<std::uint8_t> out) const {
  const int level = level_for(region, size);
  resample(luma_[level], region, 1.0 / (1 << level), size, out);
}

void Pyramid::sample_chroma(const Box& region, PatchSize size, std::span<std::uint8_t> u,
                            std::span<std::uint8_t> v) const {
  const int level = std::max(1, level_for(region, size));
  resample(u_[level], region, 1.0 / (1 << level), size, u);
  resample(v_[level], region, 1.0 / (1 << level), size, v);
}

Pyramid::Mean Pyramid::mean() const {
  const int level = levels_ - 1;
  const auto mean_of = [](const Plane& plane) {
    std::int64_t sum = 0;
    const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(plane.width_px) * plane.height_px;
    for (std::ptrdiff_t i = 0; i < count; ++i) sum += plane.data[i];
    return static_cast<double>(sum) / static_cast<double>(count);
  };
  return {mean_of(luma_[level]), mean_of(u_[level]), mean_of(v_[level])};
}

}  // namespace cgsr::imaging
