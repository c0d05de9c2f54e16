#include "pipeline/render/depth_buffer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <emmintrin.h>

namespace cgsr::render {
namespace {

/// First integer not below x, for x in [0, limit].
int first_at_or_after(double x, int limit) {
  if (!(x > 0.0)) return 0;
  if (x >= limit) return limit;
  const int whole = static_cast<int>(x);
  return whole + (x > whole ? 1 : 0);
}

}  // namespace

DepthBuffer::DepthBuffer(int width, int height)
    : width_(width),
      height_(height),
      stride_(static_cast<std::size_t>(width + 7) / 4 * 4),
      w_(stride_ * static_cast<std::size_t>(height)),
      name_(w_.size(), kNothing) {}

void DepthBuffer::clear() {
  // Plain loops: the library's memset may be a string instruction, which costs a counted instruction a byte.
  const __m128i nothing = _mm_set1_epi32(static_cast<int>(kNothing));
  for (std::size_t i = 0; i < w_.size(); i += 4) {
    _mm_storeu_ps(&w_[i], _mm_setzero_ps());
    _mm_storeu_si128(reinterpret_cast<__m128i*>(&name_[i]), nothing);
  }
}

void DepthBuffer::draw(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c,
                       const DepthPlane& plane, std::uint32_t name) {
  scan(a, b, c, [&](int y, int first, int last) { fill(y, first, last, plane, name); });
}

void DepthBuffer::mark(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c,
                       const DepthPlane& plane, std::uint8_t bits, std::uint8_t* mask) const {
  static constexpr auto kBytes = [] {
    std::array<std::uint32_t, 16> bytes{};
    for (std::uint32_t lanes = 0; lanes < 16; ++lanes) {
      for (std::uint32_t lane = 0; lane < 4; ++lane) {
        if ((lanes >> lane & 1U) != 0U) bytes[lanes] |= 0xFFU << (8U * lane);
      }
    }
    return bytes;
  }();
  const std::uint32_t wanted = bits * 0x01010101U;
  const __m128 lanes = _mm_setr_ps(0.0F, 1.0F, 2.0F, 3.0F);
  const __m128 step = _mm_set1_ps(4.0F * plane.du);
  scan(a, b, c, [&](int y, int first, int last) {
    const float* depth = &w_[at(first, y)];
    std::uint8_t* row = mask + static_cast<std::ptrdiff_t>(y) * width_;
    __m128 w = _mm_add_ps(_mm_set1_ps(plane.at(static_cast<float>(first), static_cast<float>(y))),
                          _mm_mul_ps(lanes, _mm_set1_ps(plane.du)));
    for (int x = first; x < last; x += 4, depth += 4) {
      auto nearer = static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmpgt_ps(w, _mm_loadu_ps(depth))));
      w = _mm_add_ps(w, step);
      if (nearer == 0) continue;
      if (last - x >= 4) {
        std::uint32_t four = 0;
        std::memcpy(&four, row + x, sizeof four);
        four |= kBytes[nearer] & wanted;
        std::memcpy(row + x, &four, sizeof four);
      } else {
        for (int k = x; k < last; ++k, nearer >>= 1U) {
          if ((nearer & 1U) != 0U) row[k] |= bits;
        }
      }
    }
  });
}

template <class Span>
void DepthBuffer::scan(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c,
                       Span&& span) const {
  const Eigen::Vector2f* top = &a;
  const Eigen::Vector2f* middle = &b;
  const Eigen::Vector2f* bottom = &c;
  if (middle->y() < top->y()) std::swap(top, middle);
  if (bottom->y() < middle->y()) std::swap(middle, bottom);
  if (middle->y() < top->y()) std::swap(top, middle);
  const int first = first_at_or_after(top->y(), height_);
  const int last = first_at_or_after(bottom->y(), height_);
  if (first >= last) return;
  // Corners may lie far outside of the raster, where a float's step is a part of a cell.
  const double height = static_cast<double>(bottom->y()) - top->y();
  const double long_slope = (static_cast<double>(bottom->x()) - top->x()) / height;
  const double upper = static_cast<double>(middle->y()) - top->y();
  const double lower = static_cast<double>(bottom->y()) - middle->y();
  const double upper_slope = upper > 0.0 ? (static_cast<double>(middle->x()) - top->x()) / upper : 0.0;
  const double lower_slope = lower > 0.0 ? (static_cast<double>(bottom->x()) - middle->x()) / lower : 0.0;
  const bool middle_right = middle->x() > top->x() + long_slope * upper;
  for (int y = first; y < last; ++y) {
    const double along = top->x() + long_slope * (y - static_cast<double>(top->y()));
    const double bent = y < middle->y() ? top->x() + upper_slope * (y - static_cast<double>(top->y()))
                                        : middle->x() + lower_slope * (y - static_cast<double>(middle->y()));
    const int begin = first_at_or_after(middle_right ? along : bent, width_);
    const int end = first_at_or_after(middle_right ? bent : along, width_);
    if (begin < end) span(y, begin, end);
  }
}

void DepthBuffer::fill(int y, int first, int last, const DepthPlane& plane, std::uint32_t name) {
  float* depth = &w_[at(first, y)];
  std::uint32_t* names = &name_[at(first, y)];
  const __m128 lanes = _mm_setr_ps(0.0F, 1.0F, 2.0F, 3.0F);
  const __m128 slope = _mm_set1_ps(plane.du);
  const __m128 step = _mm_set1_ps(4.0F * plane.du);
  __m128 w =
      _mm_add_ps(_mm_set1_ps(plane.at(static_cast<float>(first), static_cast<float>(y))), _mm_mul_ps(lanes, slope));
  const __m128i mine = _mm_set1_epi32(static_cast<int>(name));
  int left = last - first;
  const auto write = [&](__m128 nearer, __m128 there) {
    const __m128i mask = _mm_castps_si128(nearer);
    _mm_storeu_ps(depth, _mm_or_ps(_mm_and_ps(nearer, w), _mm_andnot_ps(nearer, there)));
    auto* const into = reinterpret_cast<__m128i*>(names);
    const __m128i old = _mm_loadu_si128(into);
    _mm_storeu_si128(into, _mm_or_si128(_mm_and_si128(mask, mine), _mm_andnot_si128(mask, old)));
  };
  for (; left >= 4; left -= 4) {
    const __m128 there = _mm_loadu_ps(depth);
    const __m128 nearer = _mm_cmpgt_ps(w, there);
    const int lanes_nearer = _mm_movemask_ps(nearer);
    if (lanes_nearer == 0xF) {
      _mm_storeu_ps(depth, w);
      _mm_storeu_si128(reinterpret_cast<__m128i*>(names), mine);
    } else if (lanes_nearer != 0) {
      write(nearer, there);
    }
    w = _mm_add_ps(w, step);
    depth += 4;
    names += 4;
  }
  if (left > 0) {  // rows are longer than the raster is wide: reading and writing back beyond the span is harmless
    const __m128 there = _mm_loadu_ps(depth);
    const __m128 inside = _mm_cmplt_ps(lanes, _mm_set1_ps(static_cast<float>(left)));
    write(_mm_and_ps(inside, _mm_cmpgt_ps(w, there)), there);
  }
}

}  // namespace cgsr::render
