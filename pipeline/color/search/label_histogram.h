#pragma once

#include <emmintrin.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cgsr::color {

/// Eight 16-bit numbers that one SSE2 register holds. Containers hold these: a template argument loses a register's alignment.
struct alignas(16) Lanes {
  std::uint16_t of[8] = {};
};

inline __m128i load(const Lanes& lanes) {
  return _mm_load_si128(reinterpret_cast<const __m128i*>(lanes.of));
}

inline void store(Lanes& lanes, __m128i values) {
  _mm_store_si128(reinterpret_cast<__m128i*>(lanes.of), values);
}

/// How many pixels have each label. Pixels of label 0 are counted in a slot of their own before the vectors, so that counting needs no branch
/// and comparing does not meet them.
/// The histogram of a region in Alg. 3.2, lines 6 and 7; the labels and the layout are ours.
class LabelHistogram {
 public:
  /// \param labels  how many, 1..labels. The vectors are filled up to a multiple of four with labels that do not occur.
  explicit LabelHistogram(int labels) : lanes_(1 + static_cast<std::size_t>(labels + 31) / 32 * 4) {}

  [[nodiscard]] int vectors() const { return static_cast<int>(lanes_.size()) - 1; }
  [[nodiscard]] const Lanes* data() const { return lanes_.data() + 1; }
  [[nodiscard]] Lanes* data() { return lanes_.data() + 1; }
  /// Element k is the count of label k, 0 included.
  [[nodiscard]] std::uint16_t* counts() { return reinterpret_cast<std::uint16_t*>(lanes_.data()) + 7; }
  void clear() { lanes_.assign(lanes_.size(), Lanes{}); }

 private:
  std::vector<Lanes> lanes_;
};

}  // namespace cgsr::color
