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
  friend Rgb operator*(const Rgb& x, const Rgb& y) { return {x.r * y.r, x.g * y.g, x.b * y.b}; }
  friend Rgb operator+(const Rgb& x, const Rgb& y) { return {x.r + y.r, x.g + y.g, x.b + y.b}; }
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// The same colours by hue. A struct, so that random parts of it are drawn in the order in which they are written.
struct Hsv {
  double hue = 0.0;         ///< in turns, any real number
  double saturation = 0.0;  ///< 0..1
  double value = 0.0;       ///< 0..1
};

inline Rgb to_rgb(const Hsv& hsv) {
  const auto channel = [&](double sixths) {
    const double k = std::fmod(sixths + (hsv.hue - std::floor(hsv.hue)) * 6.0, 6.0);
    return hsv.value - hsv.value * hsv.saturation * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0);
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
