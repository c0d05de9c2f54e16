#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "platform/time.h"

namespace cgsr::runtime {

/// Durations counted in buckets whose width grows with the value: 16 to each doubling, so that a quantile is never too
/// small and at most 1/16 too large, from nanoseconds to 18 minutes (longer ones count as that). Mean and worst are
/// exact. Fixed size, no allocation.
class Histogram {
 public:
  /// Negative durations count as zero.
  void add(Duration duration);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] Duration mean() const;  ///< zero when empty.
  [[nodiscard]] Duration worst() const { return worst_; }

  /// \param share in [0, 1]: 0.99 is the 99th percentile. \return a duration that at least this share does not exceed;
  ///       zero when empty.
  [[nodiscard]] Duration quantile(double share) const;

 private:
  static constexpr int kDoublings = 36;  // beyond the first 32 ns, which are counted one by one
  static constexpr std::size_t kBuckets = 32 + 16 * kDoublings;

  static std::size_t bucket_of(std::uint64_t ns);
  static std::uint64_t end_of(std::size_t bucket);

  std::array<std::uint64_t, kBuckets> counts_{};
  std::uint64_t count_ = 0;
  Duration sum_{};
  Duration worst_{};
};

}  // namespace cgsr::runtime
