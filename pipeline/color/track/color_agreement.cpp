#include "pipeline/color/track/color_agreement.h"

#include <cmath>

namespace cgsr::color {
namespace {

/// A value's lower bin, and its share of the upper one.
struct Position {
  std::size_t bin;
  float upper;
  Position(std::uint8_t value, int step)
      : bin(static_cast<std::size_t>(value / step)),
        upper(static_cast<float>(value % step) / static_cast<float>(step)) {}
  [[nodiscard]] float share(std::size_t i) const { return i == 0 ? 1.0F - upper : upper; }
};

}  // namespace

ColorAmounts::ColorAmounts(const ObjectView& view) {
  for (std::size_t i = 0; i < view.y.size(); ++i) count(view.y[i], view.u[i], view.v[i]);
  for (float& share : shares_) share /= static_cast<float>(view.y.size());
}

void ColorAmounts::count(std::uint8_t y, std::uint8_t u, std::uint8_t v) {
  const Position luma(y, kLumaStep);
  const Position blue(u, kChromaStep);
  const Position red(v, kChromaStep);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      float* row = shares_.data() + ((luma.bin + i) * kChromaBins + blue.bin + j) * kChromaBins + red.bin;
      const float share = luma.share(i) * blue.share(j);
      row[0] += share * red.share(0);
      row[1] += share * red.share(1);
    }
  }
}

void ColorAmounts::blend(const ColorAmounts& other, double rate) {
  const auto share = static_cast<float>(rate);
  for (std::size_t i = 0; i < shares_.size(); ++i) shares_[i] += share * (other.shares_[i] - shares_[i]);
}

double ColorAmounts::agreement(const ColorAmounts& other) const {
  float sum = 0.0F;
  for (std::size_t i = 0; i < shares_.size(); ++i) sum += std::sqrt(shares_[i] * other.shares_[i]);
  return static_cast<double>(sum);
}

}  // namespace cgsr::color
