#include "pipeline/imaging/color_code.h"

#include <algorithm>

namespace cgsr::imaging {
namespace {

double channel(double value_255) {
  return std::clamp(value_255 / 255.0, 0.0, 1.0);
}

// BT.601: luma weights of R and B; limited range stretches 219 steps of Y and 224 of U and V.
constexpr double kKr = 0.299;
constexpr double kKb = 0.114;
constexpr double kKg = 1.0 - kKr - kKb;

}  // namespace

Rgb rgb_of_yuv(double y, double u, double v) {
  const double luma = (y - 16.0) * 255.0 / 219.0;
  const double to_b = (u - 128.0) * 255.0 / 112.0 * (1.0 - kKb);
  const double to_r = (v - 128.0) * 255.0 / 112.0 * (1.0 - kKr);
  return {channel(luma + to_r), channel(luma - (kKb * to_b + kKr * to_r) / kKg), channel(luma + to_b)};
}

Yuv yuv_of_rgb(const Rgb& rgb) {
  const double luma = kKr * rgb.r + kKg * rgb.g + kKb * rgb.b;
  return {16.0 + 219.0 * luma, 128.0 + 112.0 * (rgb.b - luma) / (1.0 - kKb),
          128.0 + 112.0 * (rgb.r - luma) / (1.0 - kKr)};
}

Rgb rgb_of_code(std::uint16_t code) {
  const int y_level = code / (kChromaLevels * kChromaLevels);
  const int u_level = code / kChromaLevels % kChromaLevels;
  const int v_level = code % kChromaLevels;
  constexpr double kYStep = 256.0 / kYLevels;
  constexpr double kChromaStep = 256.0 / kChromaLevels;
  return rgb_of_yuv((y_level + 0.5) * kYStep, (u_level + 0.5) * kChromaStep, (v_level + 0.5) * kChromaStep);
}

}  // namespace cgsr::imaging
