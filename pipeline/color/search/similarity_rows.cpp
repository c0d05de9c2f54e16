#include "pipeline/color/search/similarity_rows.h"

#include <algorithm>
#include <cmath>

namespace cgsr::color {
namespace {

constexpr int kVectors = 4;
constexpr int kLights = 8 * kVectors;
constexpr std::size_t kRowBytes = kVectors * sizeof(Lanes);
constexpr std::size_t kLabelBytes = kLevels * kRowBytes;

// The price t of a share, in units, by trial on real images: it may be off by a third without much harm. Where a label's units stop
// rising at its learned share, filling it to the brim gains nothing, and a price would only loosen the bound.
int price_of(const SearchParameters& parameters) {
  if (parameters.weights == BinWeights::kSurroundings || parameters.divergence == Divergence::kIntersection) return 0;
  return parameters.divergence == Divergence::kHellinger ? kOne / 3 : kOne / 4;
}

// The least share that counts as a level.
double lowest_share(int level) {
  const double root = level == 0 ? 0.0 : (level - 0.5) / (kLevels - 1);
  return root * root;
}

// The sums of one chunk's 32 lights.
struct Sums {
  __m128i of[kVectors];

  [[nodiscard]] int highest() const {
    __m128i a = _mm_max_epi16(_mm_max_epi16(of[0], of[1]), _mm_max_epi16(of[2], of[3]));
    a = _mm_max_epi16(a, _mm_srli_si128(a, 8));
    a = _mm_max_epi16(a, _mm_srli_si128(a, 4));
    a = _mm_max_epi16(a, _mm_srli_si128(a, 2));
    return static_cast<std::int16_t>(_mm_extract_epi16(a, 0));
  }
  [[nodiscard]] int first_with(int value) const {
    const __m128i all = _mm_set1_epi16(static_cast<std::int16_t>(value));
    const __m128i low = _mm_packs_epi16(_mm_cmpeq_epi16(of[0], all), _mm_cmpeq_epi16(of[1], all));
    const __m128i high = _mm_packs_epi16(_mm_cmpeq_epi16(of[2], all), _mm_cmpeq_epi16(of[3], all));
    return __builtin_ctz(static_cast<unsigned>(_mm_movemask_epi8(low)) | static_cast<unsigned>(_mm_movemask_epi8(high))
                                                                             << 16);
  }
};

// Adds up the rows of the labels that are present. Most are not: sixteen are passed over at a time. Addresses are in bytes, because that
// is two instructions less for each label of each window. \param pixels  of labels that are present; only if wanted.
template <bool kCountPixels = false>
inline Sums add_up(const Lanes* rows, const LabelHistogram& histogram, const std::uint16_t* row_of_count,
                   int* pixels = nullptr) {
  const __m128i zero = _mm_setzero_si128();
  __m128i s0 = zero, s1 = zero, s2 = zero, s3 = zero;
  int met = 0;
  const char* of_labels = reinterpret_cast<const char*>(rows);
  const Lanes* at = histogram.data();
  for (const Lanes* end = at + histogram.vectors(); at != end; at += 2, of_labels += 16 * kLabelBytes) {
    const __m128i absent = _mm_packs_epi16(_mm_cmpeq_epi16(load(at[0]), zero), _mm_cmpeq_epi16(load(at[1]), zero));
    const std::uint16_t* counts = at->of;
    for (unsigned present = static_cast<unsigned>(_mm_movemask_epi8(absent)) ^ 0xFFFFU; present != 0;
         present &= present - 1) {
      const auto label = static_cast<unsigned>(__builtin_ctz(present));
      const auto* row = reinterpret_cast<const Lanes*>(of_labels + (label * kLabelBytes + row_of_count[counts[label]]));
      s0 = _mm_adds_epi16(s0, load(row[0]));
      s1 = _mm_adds_epi16(s1, load(row[1]));
      s2 = _mm_adds_epi16(s2, load(row[2]));
      s3 = _mm_adds_epi16(s3, load(row[3]));
      if constexpr (kCountPixels) met += counts[label];
    }
  }
  if constexpr (kCountPixels) *pixels = met;
  return {{s0, s1, s2, s3}};
}

}  // namespace

void LevelTable::prepare(int pixels, int max_count) {
  if (pixels == pixels_ && max_count <= max_count_) return;
  pixels_ = pixels;
  max_count_ = max_count;
  // Level k begins at the least count with 4 (K-1)^2 count >= pixels (2k - 1)^2.
  constexpr std::int64_t kScale = std::int64_t{4} * (kLevels - 1) * (kLevels - 1);
  int begin = 0;
  for (int level = 0; level < kLevels && begin <= max_count; ++level) {
    const std::int64_t next = (std::int64_t{pixels} * (2 * level + 1) * (2 * level + 1) + kScale - 1) / kScale;
    const int end =
        level == kLevels - 1 ? max_count + 1 : static_cast<int>(std::min<std::int64_t>(next, max_count + 1));
    std::fill(row_of_count_.begin() + begin, row_of_count_.begin() + end,
              static_cast<std::uint16_t>(static_cast<std::size_t>(level) * kRowBytes));
    begin = end;
  }
}

SimilarityRows::SimilarityRows(const Similarity& similarity, const SearchParameters& parameters)
    : labels_(similarity.labels()),
      chunks_((similarity.lights() + kLights - 1) / kLights),
      price_(price_of(parameters)) {
  const auto size = static_cast<std::size_t>(chunks_ * labels_ * kLevels * kVectors);
  exact_.resize(size);
  most_.resize(size);
  least_.resize(price_ > 0 ? size : 0);
  for (int light = 0; light < similarity.lights(); ++light) {
    for (int label = 1; label <= labels_; ++label) {
      const auto cell = [&](std::vector<Lanes>& rows, int level) -> std::uint16_t& {
        const int row = (light / kLights * labels_ + label - 1) * kLevels + level;
        return rows[static_cast<std::size_t>(row * kVectors + light % kLights / 8)].of[light % 8];
      };
      const auto after_price = [&](int level) {
        return similarity.units(label, level, light) - price_ * lowest_share(level);
      };
      double peak = 0.0;
      for (int level = 0; level < kLevels; ++level) {
        peak = std::max(peak, after_price(level));
        cell(exact_, level) = static_cast<std::uint16_t>(similarity.units(label, level, light));
        cell(most_, level) = static_cast<std::uint16_t>(std::ceil(peak));
      }
      double still = after_price(kLevels - 1);  // the most that levels from here on reach
      for (int level = kLevels - 1; level >= 0 && price_ > 0; --level) {
        still = std::max(still, after_price(level));
        cell(least_, level) = static_cast<std::uint16_t>(static_cast<std::int16_t>(std::ceil(still - peak)));
      }
    }
  }
}

BestLight SimilarityRows::best(const LabelHistogram& histogram, const LevelTable& levels) const {
  BestLight best{-1, 0};
  for (int chunk = 0; chunk < chunks_; ++chunk) {
    const Sums sums = add_up(chunk_of(exact_, chunk), histogram, levels.data());
    const int highest = sums.highest();
    if (highest > best.units) best = {highest, chunk * kLights + sums.first_with(highest)};
  }
  return best;
}

void SimilarityRows::bound(const LabelHistogram& most, const LevelTable& levels, Bound& bound) const {
  int highest = 0;
  for (int chunk = 0; chunk < chunks_; ++chunk) {
    const Sums sums = add_up(chunk_of(most_, chunk), most, levels.data());
    highest = std::max(highest, sums.highest());
    for (int v = 0; v < kVectors; ++v) store(bound.sums[static_cast<std::size_t>(chunk * kVectors + v)], sums.of[v]);
  }
  bound.units = std::min(highest + price_, kMaxUnits);
  bound.refinable = price_ > 0 && highest < kMaxUnits;  // a sum that was cut off must not be lowered
}

void SimilarityRows::refine(const LabelHistogram& least, const LevelTable& levels, int min_pixels, int pixels,
                            Bound& bound) const {
  int highest = -kMaxUnits;
  int known = 0;
  for (int chunk = 0; chunk < chunks_; ++chunk) {
    Sums sums = add_up<true>(chunk_of(least_, chunk), least, levels.data(), &known);
    for (int v = 0; v < kVectors; ++v) {
      sums.of[v] = _mm_adds_epi16(sums.of[v], load(bound.sums[static_cast<std::size_t>(chunk * kVectors + v)]));
    }
    highest = std::max(highest, sums.highest());
  }
  const auto foreign = static_cast<int>(std::int64_t{price_} * (min_pixels - known) / pixels);
  bound.units = std::clamp(highest + price_ - foreign, 0, bound.units);
}

const Lanes* SimilarityRows::chunk_of(const std::vector<Lanes>& rows, int chunk) const {
  return rows.data() + static_cast<std::ptrdiff_t>(chunk) * labels_ * kLevels * kVectors;
}

}  // namespace cgsr::color
