#include "pipeline/shade/mask_growth.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <emmintrin.h>

namespace cgsr::shade {
namespace {

// Eight cells, a bit each, as eight bytes that are 0 or 255.
constexpr std::array<std::uint64_t, 256> kBytes = [] {
  std::array<std::uint64_t, 256> bytes{};
  for (std::size_t bits = 0; bits < bytes.size(); ++bits) {
    for (unsigned k = 0; k < 8; ++k) bytes[bits] |= (bits >> k & 1U) != 0 ? std::uint64_t{0xFF} << 8U * k : 0;
  }
  return bytes;
}();

}  // namespace

MaskGrowth::MaskGrowth(int width, int height)
    : width_(width),
      height_(height),
      words_(static_cast<std::size_t>(width + 63) / 64),
      cells_(words_ * static_cast<std::size_t>(height)),
      grown_(cells_.size()),
      sideways_(cells_.size()) {}

void MaskGrowth::grow_square(std::uint8_t* mask, int cells) {
  clear();
  take(mask, 0xFF);
  for (int i = 0; i < cells; ++i) step(true);
  write(mask);
}

void MaskGrowth::grow(std::uint8_t* mask) {
  clear();
  for (int far = kMost; far >= 0; --far) {
    take(mask, static_cast<std::uint8_t>(1U << static_cast<unsigned>(far)));
    if (far > 0) step(far % 2 == 0);  // crosses and squares in turn: an octagon
  }
  write(mask);
}

void MaskGrowth::clear() {
  std::fill(cells_.begin(), cells_.end(), std::uint64_t{0});
}

/// Adds the cells that have one of the bits.
void MaskGrowth::take(const std::uint8_t* mask, std::uint8_t bits) {
  const __m128i wanted = _mm_set1_epi8(static_cast<char>(bits));
  std::uint64_t* row = cells_.data();
  for (int y = 0; y < height_; ++y, row += words_, mask += width_) {
    int x = 0;
    for (; x + 16 <= width_; x += 16) {
      const __m128i bytes = _mm_loadu_si128(reinterpret_cast<const __m128i*>(mask + x));
      const __m128i none = _mm_cmpeq_epi8(_mm_and_si128(bytes, wanted), _mm_setzero_si128());
      const auto some = static_cast<std::uint64_t>(static_cast<std::uint32_t>(_mm_movemask_epi8(none)) ^ 0xFFFFU);
      row[x / 64] |= some << static_cast<unsigned>(x % 64);
    }
    for (; x < width_; ++x) {
      if ((mask[x] & bits) != 0) row[x / 64] |= std::uint64_t{1} << static_cast<unsigned>(x % 64);
    }
  }
}

/// By one cell to all sides; to the corners too, when asked for.
void MaskGrowth::step(bool corners) {
  for (std::size_t y = 0; y < cells_.size(); y += words_) {
    for (std::size_t i = 0; i < words_; ++i) {
      const std::uint64_t left = i > 0 ? cells_[y + i - 1] >> 63U : 0;
      const std::uint64_t right = i + 1 < words_ ? cells_[y + i + 1] << 63U : 0;
      const std::uint64_t own = cells_[y + i];
      sideways_[y + i] = own | own << 1U | own >> 1U | left | right;
    }
  }
  const std::vector<std::uint64_t>& beside = corners ? sideways_ : cells_;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    std::uint64_t grown = sideways_[i];
    if (i >= words_) grown |= beside[i - words_];
    if (i + words_ < cells_.size()) grown |= beside[i + words_];
    grown_[i] = grown;
  }
  std::swap(cells_, grown_);
}

void MaskGrowth::write(std::uint8_t* mask) const {
  const std::uint64_t* row = cells_.data();
  for (int y = 0; y < height_; ++y, row += words_, mask += width_) {
    const auto bits = [row](int x) { return row[x / 64] >> static_cast<unsigned>(x % 64); };
    int x = 0;
    for (; x + 8 <= width_; x += 8) std::memcpy(mask + x, &kBytes[bits(x) & 0xFFU], 8);
    for (; x < width_; ++x) mask[x] = static_cast<std::uint8_t>(-static_cast<int>(bits(x) & 1U));
  }
}

}  // namespace cgsr::shade
