#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {

/// \return the number to a tenth of a millimetre: what a file of a generated home can hold, and the same with every compiler.
inline double rounded(double value) {
  return std::round(value * 1e4) / 1e4;
}

/// Numbers drawn from a seed, the same on every machine: hashes and exact arithmetic, no distribution of the standard library. Each part of a
/// home draws from a stream of its own, so that more numbers for one part do not move another. Ours.
class Draw {
 public:
  Draw(std::uint32_t seed, std::uint32_t stream) : key_(mix(seed, stream, 0x686f6d65U)) {}

  /// \return in [0, 1).
  double share() { return static_cast<double>(unit(mix(key_, ++drawn_))); }
  /// \return in [low, high), to a tenth of a millimetre.
  double uniform(double low, double high) { return rounded(low + (high - low) * share()); }
  /// \param count  above 0. \return in 0 .. count - 1.
  int below(int count) { return static_cast<int>(share() * count); }
  /// \return in low .. high, both included.
  int between(int low, int high) { return low + below(high - low + 1); }
  bool chance(double probability) { return share() < probability; }

  template <class T, std::size_t kCount>
  const T& pick(const std::array<T, kCount>& choices) {
    return choices[static_cast<std::size_t>(below(static_cast<int>(kCount)))];
  }

 private:
  std::uint32_t key_;
  std::uint32_t drawn_ = 0;
};

}  // namespace cgsr::sim
