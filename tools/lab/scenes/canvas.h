#pragma once

#include <cstdint>
#include <vector>

#include "platform/box.h"
#include "tools/lab/box_tracker.h"
#include "tools/lab/scenes/color.h"
#include "tools/lab/scenes/pattern.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {

/// A scene before light falls on it: the texture of what each pixel sees.
struct Canvas {
  int width_px = 0;
  int height_px = 0;
  std::vector<Rgb> pixels;  ///< row by row

  [[nodiscard]] Rgb& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x)];
  }
  [[nodiscard]] const Rgb& at(int x, int y) const { return const_cast<Canvas&>(*this).at(x, y); }
};

/// Lays the pattern into the box, edges blended by how much of a pixel the box covers; what lies outside the canvas is cut.
void paint(Canvas& canvas, const Pattern& pattern, const Box& box);

/// How the camera saw a canvas.
struct Exposure {
  Light light{1.0, 1.0, 1.0};  ///< multiplies every texture (Eq. 3.1)
  int blur_passes = 0;         ///< each a binomial (1 2 1)/4 in both directions: sigma = sqrt(passes / 2) px
  double noise = 0.0;          ///< standard deviation per channel, 1/255
};

/// \return the image of a YUYV camera, BT.601 limited range: lit, blurred, noisy, clipped, chroma halved. Width even.
std::vector<std::uint8_t> expose(const Canvas& canvas, const Exposure& exposure, Random random);

}  // namespace cgsr::lab
