#pragma once

#include <algorithm>

namespace cgsr::render {

/// Leaves of the stretch [s0, s1] what has offset + s slope >= 0 (Liang and Barsky 1984, one border).
///
/// \return false when nothing is left.
template <class Number>
bool clip(Number offset, Number slope, Number& s0, Number& s1) {
  if (slope > 0) {
    s0 = std::max(s0, -offset / slope);
  } else if (slope < 0) {
    s1 = std::min(s1, -offset / slope);
  } else if (offset < 0) {
    return false;
  }
  return s0 < s1;
}

}  // namespace cgsr::render
