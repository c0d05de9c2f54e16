#include "pipeline/runtime/histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cgsr::runtime {

void Histogram::add(Duration duration) {
  duration = std::max(duration, Duration::zero());
  ++counts_[bucket_of(static_cast<std::uint64_t>(duration.count()))];
  ++count_;
  sum_ += duration;
  worst_ = std::max(worst_, duration);
}

Duration Histogram::mean() const {
  return count_ == 0 ? Duration::zero() : sum_ / static_cast<std::int64_t>(count_);
}

Duration Histogram::quantile(double share) const {
  const auto rank =
      std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_))));
  std::uint64_t below = 0;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    below += counts_[bucket];
    if (below >= rank) return std::min(worst_, Duration{static_cast<std::int64_t>(end_of(bucket))});
  }
  return worst_;
}

// The bucket is the five leading bits of the value (16..31) and how far they were shifted; values below 32 are their
// own bucket.
std::size_t Histogram::bucket_of(std::uint64_t ns) {
  const int shift = std::max(0, static_cast<int>(std::bit_width(ns)) - 5);
  if (shift > kDoublings) return kBuckets - 1;
  return static_cast<std::size_t>(shift) * 16 + static_cast<std::size_t>(ns >> shift);
}

/// \return the largest value of that bucket.
std::uint64_t Histogram::end_of(std::size_t bucket) {
  if (bucket < 32) return bucket;
  const auto shift = bucket / 16 - 1;
  const auto leading = bucket - shift * 16;
  return ((static_cast<std::uint64_t>(leading) + 1) << shift) - 1;
}

}  // namespace cgsr::runtime
