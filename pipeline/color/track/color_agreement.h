#pragma once

#include <array>

#include "pipeline/color/track/object_view.h"

namespace cgsr::color {

/// Which colours an object has and how much of each: a histogram of Y, U, V. A colour that lies between two bins counts in both, so that a
/// small error of the light's estimate changes little. It answers what the likelihood of single pixels cannot: whether a colour is missing.
/// Ours, beside the divergence of Alg. 3.2.
class ColorAmounts {
 public:
  ColorAmounts() = default;
  explicit ColorAmounts(const ObjectView& view);

  /// Becomes more like `other`. \param rate  its share.
  void blend(const ColorAmounts& other, double rate);

  /// \return the Bhattacharyya coefficient of the two (Bhattacharyya 1943): 0, nothing in common, to 1, the same colours in the same amounts.
  [[nodiscard]] double agreement(const ColorAmounts& other) const;

 private:
  // Colours of matt things differ mostly in U and V, whose range in real images is a third of that of Y.
  static constexpr int kLumaStep = 32, kChromaStep = 12;
  static constexpr std::size_t kLumaBins = 255 / kLumaStep + 2, kChromaBins = 255 / kChromaStep + 2;

  void count(std::uint8_t y, std::uint8_t u, std::uint8_t v);

  std::array<float, kLumaBins * kChromaBins * kChromaBins> shares_{};
};

}  // namespace cgsr::color
