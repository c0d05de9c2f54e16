#pragma once

#include <algorithm>
#include <cmath>

namespace cgsr::behavior {

/// Moves `current` towards `target`: away from zero by at most `rise` per second, towards zero by at most `fall` per second. A change
/// of sign comes to zero first and goes on from there in the next step. Ours.
/// \param elapsed_s  >= 0.
inline double ramp(double current, double target, double rise, double fall, double elapsed_s) {
  if (current * target < 0.0) target = 0.0;
  const double step = (std::abs(target) > std::abs(current) ? rise : fall) * elapsed_s;
  return current + std::clamp(target - current, -step, step);
}

}  // namespace cgsr::behavior
