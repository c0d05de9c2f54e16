#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Core>

namespace cgsr::illumination {

/// How the light goes from shadow to light across a soft edge, and its derivative, out of a table. What the image blurs is the normal distribution's integral; what a
/// ball-shaped lamp softens is the share of a disc that a straight edge hides, of radius 2 where the standard deviation is 1:
///   1/2 + (u sqrt(1 - u^2) + asin u) / pi,  u = x / 2
/// Ours; the lamp of 5.1 is a point, whose shadows have sharp edges.
class SoftStep {
 public:
  SoftStep() {
    for (std::size_t i = 0; i < kEntries; ++i) {
      const double x = (static_cast<double>(i) - kZero) / kPerUnit;
      const double u = std::clamp(x / 2.0, -1.0, 1.0);
      const double gauss = 0.5 * std::erfc(-x / std::sqrt(2.0));
      const double disc = 0.5 + (u * std::sqrt(1.0 - u * u) + std::asin(u)) / std::numbers::pi;
      table_[i] = {static_cast<float>(gauss), static_cast<float>(disc - gauss)};
    }
  }

  struct Value {
    float share;    ///< 0 far outside, 1 far inside.
    float density;  ///< its derivative.
  };
  /// \param x  in standard deviations from the middle of an edge whose light is taken for normally distributed, as what the image blurs is.
  [[nodiscard]] Value at(float x) const {
    const float place = std::clamp(x * kPerUnit + kZero, 0.0F, static_cast<float>(kEntries - 2));
    const int i = static_cast<int>(place);
    const float low = table_[static_cast<std::size_t>(i)].gauss;
    const float rise = table_[static_cast<std::size_t>(i) + 1].gauss - low;
    return {low + (place - static_cast<float>(i)) * rise, rise * kPerUnit};
  }
  /// Four at once.
  void at(const Eigen::Array4f& x, Eigen::Array4f& share, Eigen::Array4f& density) const {
    const Eigen::Array4f place = (x * kPerUnit + kZero).max(0.0F).min(static_cast<float>(kEntries - 2));
    for (int k = 0; k < 4; ++k) {
      const int i = static_cast<int>(place[k]);
      const float low = table_[static_cast<std::size_t>(i)].gauss;
      const float rise = table_[static_cast<std::size_t>(i) + 1].gauss - low;
      share[k] = low + (place[k] - static_cast<float>(i)) * rise;
      density[k] = rise * kPerUnit;
    }
  }
  /// Of an edge that lamp and image soften together.
  /// \param lamp  the lamp's share of the variance. Both curves mixed by its square have the variance and the kurtosis of their convolution.
  [[nodiscard]] Value at(float x, float lamp) const {
    const float place = std::clamp(x * kPerUnit + kZero, 0.0F, static_cast<float>(kEntries - 2));
    return mixed(place, lamp * lamp);
  }
  /// Four at once.
  void at(const Eigen::Array4f& x, const Eigen::Array4f& lamp, Eigen::Array4f& share, Eigen::Array4f& density) const {
    const Eigen::Array4f place = (x * kPerUnit + kZero).max(0.0F).min(static_cast<float>(kEntries - 2));
    const Eigen::Array4f mix = lamp * lamp;
    for (int k = 0; k < 4; ++k) {
      const Value value = mixed(place[k], mix[k]);
      share[k] = value.share;
      density[k] = value.density;
    }
  }

 private:
  struct Entry {
    float gauss;
    float disc_minus_gauss;  // than the former
  };

  [[nodiscard]] Value mixed(float place, float mix) const {
    const int i = static_cast<int>(place);
    const Entry& a = table_[static_cast<std::size_t>(i)];
    const Entry& b = table_[static_cast<std::size_t>(i) + 1];
    const float low = a.gauss + mix * a.disc_minus_gauss;
    const float rise = b.gauss + mix * b.disc_minus_gauss - low;
    return {low + (place - static_cast<float>(i)) * rise, rise * kPerUnit};
  }

  static constexpr std::size_t kEntries = 130;
  static constexpr float kPerUnit = 16.0F;
  static constexpr float kZero = 64.0F;
  std::array<Entry, kEntries> table_{};
};

/// How wide the penumbra of a tip's shadow is on the board, as a standard deviation [m], per metre of the lamp's radius.
/// \param height_m  of the tip. \param lamp_height_m  likewise above the board.
inline double softness_per_radius(double height_m, double lamp_height_m) {
  return 0.5 * height_m / std::max(0.1, lamp_height_m - height_m);
}

}  // namespace cgsr::illumination
