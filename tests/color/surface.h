#pragma once

// What the tests of the light look at: surfaces of known colours, and how far two lights are apart.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "pipeline/color/learn/light.h"
#include "pipeline/color/track/object_view.h"
#include "pipeline/imaging/color_code.h"

namespace cgsr::color {

/// A surface of several colours, each in a stripe.
inline ObjectView surface(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> level(0.15, 0.75);
  ObjectView view;
  imaging::Yuv color;
  for (std::size_t i = 0; i < view.y.size(); ++i) {
    if (i % 128 == 0) color = imaging::yuv_of_rgb({level(random), level(random), level(random)});
    view.y[i] = static_cast<std::uint8_t>(std::lround(color.y));
    view.u[i] = static_cast<std::uint8_t>(std::lround(color.u));
    view.v[i] = static_cast<std::uint8_t>(std::lround(color.v));
  }
  return view;
}

/// The largest relative difference of a channel.
inline double error(const Light& a, const Light& b) {
  return std::max({std::abs(a.r / b.r - 1.0), std::abs(a.g / b.g - 1.0), std::abs(a.b / b.b - 1.0)});
}

}  // namespace cgsr::color
