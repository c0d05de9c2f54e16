#pragma once

#include <cstdint>
#include <cstdlib>

namespace cgsr::test {

/// \return how many hand-overs a stress test does: CGSR_STRESS_HANDOVERS, or without it what takes a second or two
///       under the thread sanitizer.
inline std::uint64_t stress_handovers() {
  const char* const wanted = std::getenv("CGSR_STRESS_HANDOVERS");
  const auto count = wanted == nullptr ? 0 : std::strtoull(wanted, nullptr, 10);
  return count == 0 ? 200'000 : count;
}

}  // namespace cgsr::test
