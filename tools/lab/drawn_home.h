#pragma once

#include <cstdint>

#include "hal/sim/generator/home.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {

/// Seeds below are for tuning and tests, never published.
inline constexpr std::uint64_t kTuningSeeds = 1000;

/// \return the home of a trial: one of those for tuning where the run's own seed is, never else. \param stream  of the table: another one, other homes.
inline std::uint32_t home_seed(std::uint64_t seed, std::uint64_t stream, int number) {
  const std::uint64_t drawn = Random(seed).fork(stream).fork(static_cast<std::uint64_t>(number)).next();
  if (seed < kTuningSeeds) return static_cast<std::uint32_t>(drawn % kTuningSeeds);
  return static_cast<std::uint32_t>(kTuningSeeds + drawn % (sim::kMaxHomeSeed - kTuningSeeds));
}

}  // namespace cgsr::lab
