#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>

namespace cgsr::illumination {

/// The normal distribution's integral and its density, out of a table: how the brightness goes from shadow to light across a soft edge. (A
/// ball-shaped lamp's own curve differs by less than 0.02 when it has the same standard deviation, half the penumbra's half width.)
/// Ours; the lamp of 5.1 is a point, whose shadows have sharp edges.
class SoftStep {
 public:
  SoftStep() {
    for (std::size_t i = 0; i < kEntries; ++i) {
      const double x = (static_cast<double>(i) - kZero) / kPerUnit;
      table_[i] = static_cast<float>(0.5 * std::erfc(-x / std::sqrt(2.0)));
    }
  }

  struct Value {
    float share;    ///< 0 far outside, 1 far inside.
    float density;  ///< its derivative.
  };
  [[nodiscard]] Value at(float x) const {
    const float place = std::clamp(x * kPerUnit + kZero, 0.0F, static_cast<float>(kEntries - 2));
    const int i = static_cast<int>(place);
    const float low = table_[static_cast<std::size_t>(i)];
    const float rise = table_[static_cast<std::size_t>(i) + 1] - low;
    return {low + (place - static_cast<float>(i)) * rise, rise * kPerUnit};
  }
  /// The same for four at once.
  void at(const Eigen::Array4f& x, Eigen::Array4f& share, Eigen::Array4f& density) const {
    const Eigen::Array4f place = (x * kPerUnit + kZero).max(0.0F).min(static_cast<float>(kEntries - 2));
    for (int k = 0; k < 4; ++k) {
      const int i = static_cast<int>(place[k]);
      const float low = table_[static_cast<std::size_t>(i)];
      const float rise = table_[static_cast<std::size_t>(i) + 1] - low;
      share[k] = low + (place[k] - static_cast<float>(i)) * rise;
      density[k] = rise * kPerUnit;
    }
  }

 private:
  static constexpr std::size_t kEntries = 130;
  static constexpr float kPerUnit = 16.0F;
  static constexpr float kZero = 64.0F;
  std::array<float, kEntries> table_{};
};

/// How wide the penumbra of a tip's shadow is on the board, as a standard deviation [m], per metre of the lamp's radius.
/// \param height_m  of the tip. \param lamp_height_m  likewise above the board.
inline double softness_per_radius(double height_m, double lamp_height_m) {
  return 0.5 * height_m / std::max(0.1, lamp_height_m - height_m);
}

}  // namespace cgsr::illumination
