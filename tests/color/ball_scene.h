#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/color/ball/ball_circle.h"
#include "pipeline/color/ball/shade_mask.h"
#include "pipeline/color/learn/color_model.h"
#include "pipeline/color/learn/learn.h"
#include "tests/color/scene.h"

namespace cgsr::test {

inline constexpr int kBallWidth_px = 320;
inline constexpr int kBallHeight_px = 240;
inline constexpr imaging::Rgb kOrange{0.92, 0.46, 0.10};

/// A shaded ball: brightest above, half as bright below. \param factor  of its light.
inline void paint_ball(Painting& painting, const color::Circle& circle, double factor,
                       const imaging::Rgb& color = kOrange) {
  constexpr int kFine = 4;
  for (int y = 0; y < kBallHeight_px; ++y) {
    for (int x = 0; x < kBallWidth_px; ++x) {
      int inside = 0;
      for (int i = 0; i < kFine * kFine; ++i) {
        const double dx = x + (i % kFine + 0.5) / kFine - circle.x_px;
        const double dy = y + (i / kFine + 0.5) / kFine - circle.y_px;
        if (dx * dx + dy * dy < circle.radius_px * circle.radius_px) ++inside;
      }
      if (inside == 0) continue;
      const double share = static_cast<double>(inside) / (kFine * kFine);
      const double height = std::clamp((circle.y_px - y) / circle.radius_px, -1.0, 1.0);
      const double light = factor * (0.8 + 0.2 * height);
      imaging::Rgb& pixel = painting.at(x, y);
      pixel = {pixel.r + share * (light * color.r - pixel.r), pixel.g + share * (light * color.g - pixel.g),
               pixel.b + share * (light * color.b - pixel.b)};
    }
  }
}

/// A room: a wall above a floor with a dark board in it, and a shade over its right half below, where everything is `shade` times as bright.
inline Painting ball_room(double shade = 1.0) {
  Painting painting(kBallWidth_px, kBallHeight_px);
  painting.paint([shade](int x, int y) {
    const double grain = 0.02 * std::sin(0.31 * x + 0.11 * y) + 0.02 * std::sin(0.07 * x - 0.43 * y);
    imaging::Rgb color =
        y < 110 ? imaging::Rgb{0.62 + grain, 0.66 + grain, 0.66} : imaging::Rgb{0.66 + grain, 0.60 + grain, 0.50};
    if (x > 20 && x < 60 && y > 130 && y < 200) color = {0.30, 0.32, 0.30};
    const double light = x >= kBallWidth_px / 2 && y >= 120 ? shade : 1.0;
    return color::lit(color, {light, light, light});
  });
  return painting;
}

/// Of the same room: the lower right quarter may lie in shade. 40 x 30 cells.
struct QuarterMask {
  std::vector<std::uint8_t> cells = std::vector<std::uint8_t>(40 * 30, 0);

  QuarterMask() {
    for (int y = 15; y < 30; ++y) {
      for (int x = 20; x < 40; ++x) cells[static_cast<std::size_t>(y * 40 + x)] = 255;
    }
  }
  [[nodiscard]] color::ShadeMaskView view() const { return {cells.data(), 40, 30, 40}; }
};

inline Box around(const color::Circle& circle) {
  return {circle.x_px - circle.radius_px, circle.y_px - circle.radius_px, 2 * circle.radius_px, 2 * circle.radius_px};
}

/// What is learned from a ball in the light.
inline color::ColorModel ball_model() {
  constexpr color::Circle kFirst{100.0, 60.0, 16.0};
  auto painting = ball_room();
  paint_ball(painting, kFirst, 1.0);
  color::LearnParameters parameters;
  parameters.widen = false;
  parameters.min_distinctiveness = 0.0;
  const color::Sample sample{painting.photograph(1.0, 7), around(kFirst)};
  return color::learn({&sample, 1}, parameters).value().model;
}

}  // namespace cgsr::test
