#pragma once

#include <cmath>
#include <random>

#include <Eigen/Core>

namespace cgsr::localization::testing {

/// The same numbers everywhere: std's distributions differ between libraries.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint32_t seed) : engine_(seed) {}

  double uniform(double from, double to) {
    return from + (to - from) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  double normal() {  // twelve uniforms: near enough
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform(0.0, 1.0);
    return sum;
  }
  Eigen::Vector3d normal3(double sigma) { return sigma * Eigen::Vector3d(normal(), normal(), normal()); }

 private:
  std::mt19937 engine_;
};

}  // namespace cgsr::localization::testing
