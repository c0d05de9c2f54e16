#include "pipeline/imaging/reduce.h"

#include <emmintrin.h>

#include <algorithm>
#include <cstddef>

namespace cgsr::imaging {
namespace {

// Eight pixels of the reduced image are made at a time; the last eight of a row are made again from the right edge, so that no
// width needs a second, scalar version. Names: y4 = four luma values added, u2 and v2 = two chroma values added.
constexpr int kLanes = 8;

inline __m128i load(const std::uint8_t* at) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(at));
}

// color_code() on eight pixels. `uv_low`, `uv_high`: u2 v2 u2 v2 … of pixels 0-3 and 4-7.
inline __m128i codes_of(__m128i y4, __m128i uv_low, __m128i uv_high) {
  const __m128i to_level = _mm_set1_epi16(kChromaLevels << 7);  // * 45 << 7 >> 16 = * 45 / 512
  const __m128i radix = _mm_set1_epi32(kChromaLevels | 1 << 16);
  const __m128i low = _mm_madd_epi16(_mm_mulhi_epu16(uv_low, to_level), radix);
  const __m128i high = _mm_madd_epi16(_mm_mulhi_epu16(uv_high, to_level), radix);
  const __m128i y_level = _mm_srli_epi16(y4, 5);
  return _mm_add_epi16(_mm_mullo_epi16(y_level, _mm_set1_epi16(kChromaLevels * kChromaLevels)),
                       _mm_packs_epi32(low, high));
}

inline void store_labels(__m128i codes, const std::uint16_t* table, std::uint16_t* out) {
  __m128i labels = _mm_cvtsi32_si128(table[_mm_extract_epi16(codes, 0)]);
  labels = _mm_insert_epi16(labels, table[_mm_extract_epi16(codes, 1)], 1);
  labels = _mm_insert_epi16(labels, table[_mm_extract_epi16(codes, 2)], 2);
  labels = _mm_insert_epi16(labels, table[_mm_extract_epi16(codes, 3)], 3);
  labels = _mm_insert_epi16(labels, table[_mm_extract_epi16(codes, 4)], 4);
  labels = _mm_insert_epi16(labels, table[_mm_extract_epi16(codes, 5)], 5);
  labels = _mm_insert_epi16(labels, table[_mm_extract_epi16(codes, 6)], 6);
  labels = _mm_insert_epi16(labels, table[_mm_extract_epi16(codes, 7)], 7);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(out), labels);
}

inline void store_grey(__m128i grey16, std::uint8_t* out) {
  _mm_storel_epi64(reinterpret_cast<__m128i*>(out), _mm_packus_epi16(grey16, grey16));
}

// What a row of the reduced image is made from and goes to.
struct Row {
  const std::uint8_t* upper;
  const std::uint8_t* lower;  // the same row at full resolution
  const std::uint16_t* table;
  std::uint8_t* grey;
  std::uint16_t* labels;
};

// 16 camera pixels of two rows to the 8 at x: YUYV is luma in the low bytes of 16-bit words and U, V in turn in the high ones.
inline void halve_eight(const Row& row, std::ptrdiff_t x) {
  const __m128i luma = _mm_set1_epi16(0xFF);
  const __m128i ones = _mm_set1_epi16(1);
  const __m128i a0 = load(row.upper + x * 4), a1 = load(row.upper + x * 4 + 16);
  const __m128i b0 = load(row.lower + x * 4), b1 = load(row.lower + x * 4 + 16);

  const __m128i y0 = _mm_madd_epi16(_mm_add_epi16(_mm_and_si128(a0, luma), _mm_and_si128(b0, luma)), ones);
  const __m128i y1 = _mm_madd_epi16(_mm_add_epi16(_mm_and_si128(a1, luma), _mm_and_si128(b1, luma)), ones);
  const __m128i y4 = _mm_packs_epi32(y0, y1);
  store_grey(_mm_srli_epi16(_mm_add_epi16(y4, _mm_set1_epi16(2)), 2), row.grey + x);

  const __m128i uv0 = _mm_add_epi16(_mm_srli_epi16(a0, 8), _mm_srli_epi16(b0, 8));
  const __m128i uv1 = _mm_add_epi16(_mm_srli_epi16(a1, 8), _mm_srli_epi16(b1, 8));
  store_labels(codes_of(y4, uv0, uv1), row.table, row.labels + x);
}

// 8 camera pixels to the 8 at x: each pair's chroma serves both of its pixels.
inline void keep_eight(const Row& row, std::ptrdiff_t x) {
  const __m128i a = load(row.upper + x * 2);
  const __m128i y = _mm_and_si128(a, _mm_set1_epi16(0xFF));
  store_grey(y, row.grey + x);
  const __m128i uv2 = _mm_slli_epi16(_mm_srli_epi16(a, 8), 1);
  const __m128i codes = codes_of(_mm_slli_epi16(y, 2), _mm_unpacklo_epi32(uv2, uv2), _mm_unpackhi_epi32(uv2, uv2));
  store_labels(codes, row.table, row.labels + x);
}

// `eight` for a whole row. At full resolution widths are even, so that starting again from the end tears no pair apart.
template <void (*eight)(const Row&, std::ptrdiff_t)>
void every_eight(const Row row, std::ptrdiff_t width) {
  for (std::ptrdiff_t x = 0; x < width - kLanes; x += kLanes) eight(row, x);
  eight(row, width - kLanes);
}

}  // namespace

std::string_view to_string(ReduceFailure failure) {
  switch (failure) {
    case ReduceFailure::kNotYuyv:
      return "not YUYV";
    case ReduceFailure::kBadSize:
      return "bad size";
    case ReduceFailure::kBadFactor:
      return "bad factor";
    case ReduceFailure::kBadTable:
      return "bad label table";
  }
  return "";
}

ReducedImage::ReducedImage(int max_width_px, int max_height_px)
    : grey(static_cast<std::size_t>(max_width_px) * static_cast<std::size_t>(max_height_px)), labels(grey.size()) {}

tl::expected<void, ReduceFailure> reduce(const ImageView& image, int factor, const LabelTable& table,
                                         ReducedImage& out) {
  if (image.empty() || image.format != PixelFormat::kYuyv) return tl::unexpected(ReduceFailure::kNotYuyv);
  if (factor != 1 && factor != 2) return tl::unexpected(ReduceFailure::kBadFactor);
  if (table.size() != static_cast<std::size_t>(kColorCodes)) return tl::unexpected(ReduceFailure::kBadTable);
  const int width = image.width_px / factor;
  const int height = image.height_px / factor;
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (image.width_px < 16 || image.height_px < 16 || image.width_px % 2 != 0 || pixels > out.grey.size()) {
    return tl::unexpected(ReduceFailure::kBadSize);
  }

  out.factor = factor;
  out.width_px = width;
  out.height_px = height;
  for (int y = 0; y < height; ++y) {
    const auto at = static_cast<std::ptrdiff_t>(y) * width;
    const Row row{image.row(y * factor), image.row(y * factor + factor - 1), table.data(), out.grey.data() + at,
                  out.labels.data() + at};
    factor == 2 ? every_eight<halve_eight>(row, width) : every_eight<keep_eight>(row, width);
  }
  return {};
}

int reduction_for(int width_px, int height_px, double object_shorter_side_px) {
  const bool small_image = std::min(width_px, height_px) < 200;
  const bool small_object = object_shorter_side_px < 24.0 && height_px <= 400;
  return small_image || small_object ? 1 : 2;
}

}  // namespace cgsr::imaging
