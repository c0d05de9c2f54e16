#include "pipeline/imaging/pyramid.h"

#include <emmintrin.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace cgsr::imaging {
namespace {

constexpr int kLongestPatchSide_px = 256;
constexpr int kCoarsestSide_px = 8;

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
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* a = image.row(2 * y);
    const std::uint8_t* b = image.row(2 * y + 1);
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(y) * width;
    int x = 0;
    for (; x + 4 <= width; x += 4) {  // 16 bytes: Y0 U0 Y1 V0 ... are four pixels of level 1
      const __m128i top = _mm_loadu_si128(reinterpret_cast<const __m128i*>(a + 4 * x));
      const __m128i bottom = _mm_loadu_si128(reinterpret_cast<const __m128i*>(b + 4 * x));
      const __m128i luma = _mm_add_epi16(_mm_and_si128(top, low), _mm_and_si128(bottom, low));
      const __m128i mean = _mm_srli_epi32(_mm_add_epi32(_mm_madd_epi16(luma, ones), two), 2);
      const __m128i chroma = _mm_avg_epu16(_mm_srli_epi16(top, 8), _mm_srli_epi16(bottom, 8));  // U V U V ...
      const __m128i u = _mm_and_si128(chroma, _mm_set1_epi32(0xffff));
      const __m128i v = _mm_srli_epi32(chroma, 16);
      const auto store = [x, at](std::uint8_t* out, __m128i four) {
        const __m128i words = _mm_packs_epi32(four, four);
        const int bytes = _mm_cvtsi128_si32(_mm_packus_epi16(words, words));
        std::copy_n(reinterpret_cast<const std::uint8_t*>(&bytes), 4, out + at + x);
      };
      store(y_out, mean);
      store(u_out, u);
      store(v_out, v);
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

/// Where the columns (or rows) of a patch fall in a plane: the left neighbour's offset, the step to the right one, and the weight of the
/// right one in 1/256.
struct Taps {
  std::array<int, kLongestPatchSide_px> first;
  std::array<int, kLongestPatchSide_px> second;
  std::array<int, kLongestPatchSide_px> weight;

  Taps(double origin, double step, int count, int length) {
    for (int i = 0; i < count; ++i) {
      const double position = std::clamp(origin + (i + 0.5) * step - 0.5, -1e6, 1e6);
      const double floor = std::floor(position);
      const int left = static_cast<int>(floor);
      first[static_cast<std::size_t>(i)] = std::clamp(left, 0, length - 1);
      second[static_cast<std::size_t>(i)] = std::clamp(left + 1, 0, length - 1);
      weight[static_cast<std::size_t>(i)] = static_cast<int>((position - floor) * 256.0);
    }
  }
};

void resample(const Plane& plane, const Box& region, double scale, PatchSize size, std::span<std::uint8_t> out) {
  assert(size.width_px <= kLongestPatchSide_px && size.height_px <= kLongestPatchSide_px && out.size() >= size.area());
  Taps columns(region.x * scale, region.width * scale / size.width_px, size.width_px, plane.width_px);
  const Taps rows(region.y * scale, region.height * scale / size.height_px, size.height_px, plane.height_px);
  for (int i = 0; i < size.width_px; ++i) {
    columns.first[static_cast<std::size_t>(i)] *= plane.pixel_stride;
    columns.second[static_cast<std::size_t>(i)] *= plane.pixel_stride;
  }
  std::uint8_t* to = out.data();
  for (int j = 0; j < size.height_px; ++j) {
    const auto row = static_cast<std::size_t>(j);
    const std::uint8_t* a = plane.data + rows.first[row] * plane.stride_bytes;
    const std::uint8_t* b = plane.data + rows.second[row] * plane.stride_bytes;
    const int down = rows.weight[row];
    for (int i = 0; i < size.width_px; ++i) {
      const auto column = static_cast<std::size_t>(i);
      const int left = columns.first[column];
      const int right = columns.second[column];
      const int across = columns.weight[column];
      const int top = a[left] * 256 + (a[right] - a[left]) * across;
      const int bottom = b[left] * 256 + (b[right] - b[left]) * across;
      *to++ = static_cast<std::uint8_t>((top * 256 + (bottom - top) * down + 32768) >> 16);
    }
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
