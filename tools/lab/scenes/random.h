#pragma once

#include <cstdint>

namespace cgsr::lab {

/// Uniform numbers that are the same on every machine, compiler and library: SplitMix64, and only exact arithmetic after it.
/// (The standard's distributions differ from library to library.)
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    return mix(state_);
  }

  /// \return in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// \param count > 0. \return in 0 .. count - 1.
  int below(int count) { return static_cast<int>(uniform() * count); }
  bool chance(double probability) { return uniform() < probability; }

  /// Mean 0, standard deviation 1, never beyond 6: the sum of twelve uniform numbers (no logarithm, whose last bit is the library's).
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

  /// A stream of its own for the part named by `label`, so that drawing more for one part does not move another.
  [[nodiscard]] Random fork(std::uint64_t label) const { return Random(mix(state_ ^ mix(label))); }

  /// SplitMix64's finaliser: every input bit moves every output bit.
  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

}  // namespace cgsr::lab
