#include "pipeline/imaging/edge_pixels.h"

#include <emmintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace cgsr::imaging {
namespace {

constexpr int kLanes = 8;

/// Standard deviation of a slope in an image whose noise has the deviation 1: sqrt((1+4+4+1) * (1+16+36+16+1)).
constexpr double kNoiseGain = 26.46;

/// A parabola through three samples of a bell as wide as this blur leaves a sharp edge pulls its top to the pixel's centre; measured on
/// rendered edges. Nothing at 0 and at half a pixel, where symmetry holds it.
constexpr float kParabolaPull = 0.18F;

__m128i load_words(const std::int16_t* from) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
}
void store_words(std::int16_t* to, __m128i words) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), words);
}
__m128i load_bytes(const std::uint8_t* from) {
  return _mm_unpacklo_epi8(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from)), _mm_setzero_si128());
}
__m128i absolute(__m128i words) {
  return _mm_max_epi16(words, _mm_sub_epi16(_mm_setzero_si128(), words));
}
__m128i twice(__m128i words) {
  return _mm_slli_epi16(words, 1);
}

/// 1 4 6 4 1.
__m128i binomial(__m128i a, __m128i b, __m128i c, __m128i d, __m128i e) {
  const __m128i inner = _mm_slli_epi16(_mm_add_epi16(_mm_add_epi16(b, d), c), 2);
  return _mm_add_epi16(_mm_add_epi16(_mm_add_epi16(a, e), twice(c)), inner);
}

/// -1 -2 0 2 1.
__m128i rise(__m128i a, __m128i b, __m128i d, __m128i e) {
  return _mm_add_epi16(_mm_sub_epi16(e, a), twice(_mm_sub_epi16(d, b)));
}

/// Calls `block(x)` so that [first, last) is covered by blocks of eight; the last one is moved back to end at `last`.
template <class Block>
void in_blocks(int first, int last, Block block) {
  int x = first;
  for (; x + kLanes <= last; x += kLanes) block(x);
  if (x < last) block(last - kLanes);
}

float steepest_point(int before, int middle, int after) {
  const int bend = 2 * middle - before - after;  // > 0: the middle is the greatest
  const float offset = 0.5F * static_cast<float>(after - before) / static_cast<float>(std::max(bend, 1));
  const float corrected = offset + kParabolaPull * offset * (1.0F - 4.0F * offset * offset);
  return std::clamp(corrected, -0.5F, 0.5F);
}

}  // namespace

EdgeDetector::EdgeDetector(const EdgeParameters& parameters, int max_width_px, int max_height_px)
    : parameters_(parameters), max_width_(max_width_px), max_height_(max_height_px), row_(max_width_px + kPad) {
  const auto row = static_cast<std::size_t>(row_);
  const std::size_t pixels = static_cast<std::size_t>(max_width_px) * static_cast<std::size_t>(max_height_px);
  smoothed_.resize(row);
  rising_.resize(row);
  gx_.resize(kRing * row);
  gy_.resize(kRing * row);
  steepness_.resize(kRing * row);
  edges_.resize(pixels / 4 + 1);
  parent_.resize(edges_.size());
  has_strong_.resize(edges_.size());
  map_.resize(pixels);
}

std::span<const EdgePixel> EdgeDetector::find(const std::uint8_t* grey, int width_px, int height_px,
                                              std::ptrdiff_t stride, const std::uint8_t* mask) {
  for (std::size_t i = 0; i < count_; ++i) map_[static_cast<std::size_t>(edges_[i].y * width_ + edges_[i].x)] = 0;
  count_ = 0;
  width_ = width_px;
  height_ = height_px;
  if (std::min(width_px, height_px) < kLeastSide_px || width_px > max_width_ || height_px > max_height_) return {};

  measure_noise(grey, stride);
  const double floor = parameters_.noise_factor * kNoiseGain * noise_;
  const double least = std::max(parameters_.min_contrast * kStepGain, floor);
  const double strong = std::max(parameters_.min_strong_contrast * kStepGain, 1.6 * floor);
  least_ = static_cast<std::int16_t>(std::min(least, 32000.0));
  strong_ = static_cast<std::int16_t>(std::min(strong, 32000.0));

  for (int i = 0; i < kRing; ++i) {  // beside the columns that slopes are made of
    std::int16_t* row = ring(steepness_, i);
    row[0] = row[1] = row[width_ - 2] = row[width_ - 1] = 0;
  }
  for (int y = 2; y < height_ - 2; ++y) {
    slopes_of_row(grey, stride, y);
    if (y > kBorder_px) thin_row(y - 1, mask);
  }
  keep_strong();
  return edges();
}

/// Immerkaer's mask, blind to flat, sloping and straight things, at about a thousand places; the median is not moved by the few edges among
/// them. The mask's response to noise of deviation 1 has the deviation 6.
void EdgeDetector::measure_noise(const std::uint8_t* grey, std::ptrdiff_t stride) {
  constexpr int kBins = 512;
  constexpr double kMedianOfNormal = 0.6745;
  std::array<std::uint16_t, kBins> counts{};
  const int step_y = std::max(1, height_ / 27);
  const int step_x = std::max(1, width_ / 37);
  int samples = 0;
  for (int y = 1; y < height_ - 1; y += step_y) {
    const std::uint8_t* middle = grey + y * stride;
    const std::uint8_t* above = middle - stride;
    const std::uint8_t* below = middle + stride;
    for (int x = 1 + y % step_x; x < width_ - 1; x += step_x) {
      const int corners = above[x - 1] + above[x + 1] + below[x - 1] + below[x + 1];
      const int sides = above[x] + below[x] + middle[x - 1] + middle[x + 1];
      const int response = std::abs(corners - 2 * sides + 4 * middle[x]);
      ++counts[static_cast<std::size_t>(std::min(response, kBins - 1))];
      ++samples;
    }
  }
  int below_it = 0;
  int median = 0;
  while (median < kBins - 1 && 2 * (below_it + counts[static_cast<std::size_t>(median)]) < samples) {
    below_it += counts[static_cast<std::size_t>(median)];
    ++median;
  }
  noise_ = median / (6.0 * kMedianOfNormal);
}

void EdgeDetector::slopes_of_row(const std::uint8_t* grey, std::ptrdiff_t stride, int y) {
  const std::uint8_t* middle = grey + y * stride;
  std::int16_t* smoothed = smoothed_.data();
  std::int16_t* rising = rising_.data();
  in_blocks(0, width_, [=](int x) {
    const __m128i a = load_bytes(middle - 2 * stride + x);
    const __m128i b = load_bytes(middle - stride + x);
    const __m128i c = load_bytes(middle + x);
    const __m128i d = load_bytes(middle + stride + x);
    const __m128i e = load_bytes(middle + 2 * stride + x);
    store_words(smoothed + x, binomial(a, b, c, d, e));
    store_words(rising + x, rise(a, b, d, e));
  });
  std::int16_t* gx = ring(gx_, y);
  std::int16_t* gy = ring(gy_, y);
  std::int16_t* steepness = ring(steepness_, y);
  in_blocks(2, width_ - 2, [=](int x) {
    const __m128i right = rise(load_words(smoothed + x - 2), load_words(smoothed + x - 1), load_words(smoothed + x + 1),
                               load_words(smoothed + x + 2));
    const __m128i down = binomial(load_words(rising + x - 2), load_words(rising + x - 1), load_words(rising + x),
                                  load_words(rising + x + 1), load_words(rising + x + 2));
    store_words(gx + x, right);
    store_words(gy + x, down);
    const __m128i right_size = absolute(right);
    const __m128i down_size = absolute(down);
    // The length to 12 %, the same along one edge: max + min / 2.
    const __m128i half_lesser = _mm_srli_epi16(_mm_min_epi16(right_size, down_size), 1);
    store_words(steepness + x, _mm_add_epi16(_mm_max_epi16(right_size, down_size), half_lesser));
  });
}

void EdgeDetector::thin_row(int y, const std::uint8_t* mask) {
  const std::int16_t* above = ring(steepness_, y - 1);
  const std::int16_t* here = ring(steepness_, y);
  const std::int16_t* below = ring(steepness_, y + 1);
  const std::int16_t* gx = ring(gx_, y);
  const std::int16_t* gy = ring(gy_, y);
  const __m128i least = _mm_set1_epi16(least_);
  const int end = width_ - kBorder_px;
  for (int x = kBorder_px; x < end; x += kLanes) {
    const __m128i m = load_words(here + x);
    const __m128i steep = _mm_cmpgt_epi16(m, least);
    if (_mm_movemask_epi8(steep) == 0) continue;
    const __m128i flat =
        _mm_cmpgt_epi16(absolute(load_words(gy + x)), absolute(load_words(gx + x)));  // edge rather level
    const __m128i no_row =
        _mm_or_si128(_mm_cmpgt_epi16(load_words(here + x + 1), m), _mm_cmplt_epi16(m, load_words(here + x - 1)));
    const __m128i no_column =
        _mm_or_si128(_mm_cmpgt_epi16(load_words(below + x), m), _mm_cmplt_epi16(m, load_words(above + x)));
    // Of two that are equally steep the right or lower one counts.
    const __m128i tie_row = _mm_cmpeq_epi16(m, load_words(here + x + 1));
    const __m128i tie_column = _mm_cmpeq_epi16(m, load_words(below + x));
    const __m128i beaten = _mm_or_si128(_mm_and_si128(flat, _mm_or_si128(no_column, tie_column)),
                                        _mm_andnot_si128(flat, _mm_or_si128(no_row, tie_row)));
    const __m128i best = _mm_andnot_si128(beaten, steep);
    auto bits = static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(best, _mm_setzero_si128())));
    if (x + kLanes > end) bits &= (1U << static_cast<unsigned>(end - x)) - 1U;
    for (; bits != 0; bits &= bits - 1) {
      const int at = x + std::countr_zero(bits);
      if (mask != nullptr && mask[y * width_ + at] != 0) continue;
      add(at, y);
    }
  }
}

void EdgeDetector::add(int x, int y) {
  if (count_ == edges_.size()) return;
  const std::int16_t* here = ring(steepness_, y);
  EdgePixel edge;
  edge.x = static_cast<std::int16_t>(x);
  edge.y = static_cast<std::int16_t>(y);
  edge.gx = ring(gx_, y)[x];
  edge.gy = ring(gy_, y)[x];
  edge.offset = edge.across_row() ? steepest_point(here[x - 1], here[x], here[x + 1])
                                  : steepest_point(ring(steepness_, y - 1)[x], here[x], ring(steepness_, y + 1)[x]);
  const auto number = static_cast<std::uint32_t>(count_++);
  edges_[number] = edge;
  parent_[number] = number;
  has_strong_[number] = here[x] > strong_ ? 1 : 0;

  // What touches it and came before: left, and the three above.
  std::uint32_t* entry = map_.data() + static_cast<std::ptrdiff_t>(y) * width_ + x;
  *entry = number + 1;
  const std::uint32_t* up = entry - width_;
  if (entry[-1] != 0) join(number, entry[-1] - 1);
  if (up[0] != 0) {
    join(number, up[0] - 1);  // the ones beside it hang together with it already
    return;
  }
  if (up[-1] != 0) join(number, up[-1] - 1);
  if (up[1] != 0) join(number, up[1] - 1);
}

std::uint32_t EdgeDetector::root_of(std::uint32_t candidate) {
  while (parent_[candidate] != candidate) {
    parent_[candidate] = parent_[parent_[candidate]];
    candidate = parent_[candidate];
  }
  return candidate;
}

void EdgeDetector::join(std::uint32_t one, std::uint32_t other) {
  one = root_of(one);
  other = root_of(other);
  if (one == other) return;
  const std::uint32_t first = std::min(one, other);
  const std::uint32_t second = std::max(one, other);
  parent_[second] = first;
  has_strong_[first] |= has_strong_[second];
}

void EdgeDetector::keep_strong() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const EdgePixel edge = edges_[i];
    std::uint32_t& entry = map_[static_cast<std::size_t>(edge.y * width_ + edge.x)];
    if (has_strong_[root_of(static_cast<std::uint32_t>(i))] == 0) {
      entry = 0;
      continue;
    }
    edges_[kept] = edge;
    entry = static_cast<std::uint32_t>(++kept);
  }
  count_ = kept;
}

}  // namespace cgsr::imaging
