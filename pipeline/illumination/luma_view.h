#pragma once

#include <cstddef>
#include <cstdint>

#include "platform/image_view.h"

namespace cgsr::illumination {

/// Which levels of an image mean light.
struct LightLevels {
  double black =
      0.0;  ///< the level of no light at all; below 0 in a difference of two images, of which neither is dark.
  double saturated = 255.0;  ///< from this level on the image holds no more light.
};

constexpr LightLevels light_levels_of(PixelFormat format) {
  return format == PixelFormat::kYuyv ? LightLevels{16.0, 233.5} : LightLevels{0.0, 253.5};
}

/// The brightness of an image as it lies there, YUYV or grey, read between pixels: no grey copy is made for the few places that are looked at.
/// In place of Alg. 5.1, line 2.
class LumaView {
 public:
  explicit LumaView(const ImageView& image) : LumaView(image, light_levels_of(image.format)) {}
  LumaView(const ImageView& image, const LightLevels& levels)
      : data_(image.data),
        stride_(image.stride_bytes),
        step_(bytes_per_pixel(image.format)),
        width_(image.width_px),
        height_(image.height_px),
        levels_(levels) {}

  [[nodiscard]] const LightLevels& levels() const { return levels_; }

  /// Are all four neighbours of (x, y) inside, with so many pixels to spare?
  [[nodiscard]] bool holds(double x, double y, double margin_px = 0.0) const {
    return x >= margin_px && y >= margin_px && x <= width_ - 1.001 - margin_px && y <= height_ - 1.001 - margin_px;
  }

  /// Bilinear, in levels of 0..255; (x, y) is inside.
  [[nodiscard]] float at(double x, double y) const { return at(static_cast<float>(x), static_cast<float>(y)); }
  [[nodiscard]] float at(float x, float y) const {
    const int column = static_cast<int>(x);
    const int row = static_cast<int>(y);
    const float fx = x - static_cast<float>(column);
    const float fy = y - static_cast<float>(row);
    const std::uint8_t* upper = data_ + row * stride_ + static_cast<std::ptrdiff_t>(column) * step_;
    const std::uint8_t* lower = upper + stride_;
    const float a = static_cast<float>(upper[0]);
    const float b = static_cast<float>(upper[step_]);
    const float c = static_cast<float>(lower[0]);
    const float d = static_cast<float>(lower[step_]);
    const float top = a + fx * (b - a);
    const float bottom = c + fx * (d - c);
    return top + fy * (bottom - top);
  }

 private:
  const std::uint8_t* data_;
  std::ptrdiff_t stride_;
  int step_;
  int width_;
  int height_;
  LightLevels levels_;
};

}  // namespace cgsr::illumination
