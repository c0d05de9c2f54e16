#pragma once

#include <chrono>
#include <cstdint>

namespace cgsr {

/// Names the one time line of the program: CLOCK_MONOTONIC on the robot, stamps in replay and simulation. It has no now():
/// asking for the time needs a Clock (platform/clock.h), so that nothing reads it by accident.
struct MonoTimeLine {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<MonoTimeLine>;
  static constexpr bool is_steady = true;
};

using MonoTime = MonoTimeLine::time_point;
using Duration = std::chrono::nanoseconds;

/// \param seconds any finite value within +-292 years.
constexpr Duration seconds(double seconds) {
  return Duration{static_cast<std::int64_t>(seconds * 1e9)};
}

constexpr double to_seconds(Duration duration) {
  return static_cast<double>(duration.count()) * 1e-9;
}

}  // namespace cgsr
