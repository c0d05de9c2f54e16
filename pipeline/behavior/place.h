#pragma once

#include <cmath>

namespace cgsr::behavior {

/// A place on the floor, world frame. Ours.
struct Place {
  double x_m = 0.0;
  double y_m = 0.0;
};

/// \return how far two places are from each other [m].
inline double distance_m(const Place& a, const Place& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

}  // namespace cgsr::behavior
