#include "pipeline/color/learn/distinctiveness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::color {
namespace {

constexpr double kShading = 1.4;
constexpr double kNoise = 0.07;
constexpr std::size_t kMostColors = 512;   // tried as c
constexpr std::size_t kMostPixels = 8192;  // looked at for each

double dot(const imaging::Rgb& a, const imaging::Rgb& b) {
  return a.r * b.r + a.g * b.g + a.b * b.b;
}

bool explains(const imaging::Rgb& c, const imaging::Rgb& pixel) {
  const double s = std::clamp(dot(pixel, c) / std::max(dot(c, c), 1e-9), 1.0 / kShading, kShading);
  const imaging::Rgb off{pixel.r - s * c.r, pixel.g - s * c.g, pixel.b - s * c.b};
  return dot(off, off) <= kNoise * kNoise;
}

// Jensen-Shannon divergence between a distribution and its own part of mass m, renormalised.
double divergence_to_part(double m) {
  const double part = m > 0.0 ? m * std::log(2.0 * m / (1.0 + m)) : 0.0;
  return 0.5 * (std::log(2.0 / (1.0 + m)) + part + (1.0 - m) * std::numbers::ln2);
}

}  // namespace

Distinctiveness distinctiveness_of(std::span<const imaging::Rgb> textures) {
  if (textures.empty()) return {};
  const std::size_t color_step = (textures.size() + kMostColors - 1) / kMostColors;
  const std::size_t pixel_step = (textures.size() + kMostPixels - 1) / kMostPixels;
  std::size_t most = 0;
  std::size_t looked_at = 0;
  for (std::size_t c = 0; c < textures.size(); c += color_step) {
    std::size_t explained = 0;
    looked_at = 0;
    for (std::size_t i = 0; i < textures.size(); i += pixel_step, ++looked_at)
      explained += explains(textures[c], textures[i]) ? 1 : 0;
    most = std::max(most, explained);
  }
  const double m = static_cast<double>(most) / static_cast<double>(looked_at);
  return {divergence_to_part(m), m};
}

}  // namespace cgsr::color
