#pragma once

#include <algorithm>
#include <cmath>

namespace cgsr::lab {

/// R, G, B in [0, 1], sRGB-encoded: what a surface shows under the light (1, 1, 1).
struct Rgb {
  double r = 0.0;
  double g = 0.0;
  double b = 0.0;

  friend Rgb operator*(const Rgb& a, double s) { return {a.r * s, a.g * s, a.b * s}; }
  friend Rgb operator*(const Rgb& a, const Rgb& b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
  friend Rgb operator+(const Rgb& a, const Rgb& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// \param hue  in turns, any real number. \param saturation, value  in [0, 1].
inline Rgb of_hsv(double hue, double saturation, double value) {
  const auto channel = [&](double sixths) {
    const double k = std::fmod(sixths + (hue - std::floor(hue)) * 6.0, 6.0);
    return value - value * saturation * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0);
  };
  return {channel(5.0), channel(3.0), channel(1.0)};
}

inline double saturation_of(const Rgb& c) {
  const double high = std::max({c.r, c.g, c.b});
  return high > 0.0 ? (high - std::min({c.r, c.g, c.b})) / high : 0.0;
}

/// \return in turns, [0, 1); 0 for greys.
inline double hue_of(const Rgb& c) {
  const double high = std::max({c.r, c.g, c.b});
  const double span = high - std::min({c.r, c.g, c.b});
  if (!(span > 0.0)) return 0.0;
  const double sixths = high == c.r   ? (c.g - c.b) / span
                        : high == c.g ? 2.0 + (c.b - c.r) / span
                                      : 4.0 + (c.r - c.g) / span;
  return sixths < 0.0 ? sixths / 6.0 + 1.0 : sixths / 6.0;
}

/// \return how far apart two hues are on the circle, in turns, 0 .. 0.5.
inline double hue_distance(double a, double b) {
  const double apart = std::abs(a - b) - std::floor(std::abs(a - b));
  return std::min(apart, 1.0 - apart);
}

}  // namespace cgsr::lab
