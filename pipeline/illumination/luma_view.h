#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "platform/image_view.h"

namespace cgsr::illumination {

/// How the levels of an image code light, by the sRGB transfer function (IEC 61966-2-1) above its linear foot, as cameras do unless they say
/// something else (V4L2_XFER_FUNC_SRGB):
///   level = zero + k light^(1 / kLightPower)
struct LightLevels {
  double zero = 0.0;  ///< below what is black; lower still in a difference of two images, of which neither is dark.
  double saturated = 255.0;  ///< from this level on a grey image holds no more light; YUYV is asked for its colours.
};
inline constexpr double kLightPower = 2.4;

constexpr LightLevels light_levels_of(PixelFormat format) {
  constexpr double kOffset = 0.055;  // of the range from black to white
  return format == PixelFormat::kYuyv ? LightLevels{16.0 - kOffset * 219.0, 255.0}
                                      : LightLevels{-kOffset * 255.0, 253.5};
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

  /// Can one of the four neighbours hold no more light, in any of its colours? The light of a warm lamp is too much for red before it is for the brightness.
  /// \param level  at(x, y): a level below kMinClippedLevel is that of its unclipped neighbours.
  [[nodiscard]] bool is_clipped(double x, double y, float level) const {
    if (level < kMinClippedLevel) return false;
    const auto column = static_cast<std::ptrdiff_t>(x);
    const std::uint8_t* upper = data_ + static_cast<std::ptrdiff_t>(y) * stride_;
    for (const std::uint8_t* row : {upper, upper + stride_}) {
      if (is_clipped(row, column) || is_clipped(row, column + 1)) return true;
    }
    return false;
  }

  /// What a pixel shows, 0 to 255 from black to white.
  struct Shown {
    float brightness;
    float brightest_color;  ///< of red, green and blue; of a grey image the brightness.
  };
  /// Of the upper left of the four neighbours of (x, y). BT.601 takes the colours out of YUYV.
  [[nodiscard]] Shown shown_at(float x, float y) const {
    return shown(data_ + static_cast<std::ptrdiff_t>(y) * stride_, static_cast<std::ptrdiff_t>(x));
  }
  /// Up to here a colour surely says how much light there was, 0 to 255: noise, and in YUYV the chroma that two pixels share, leave more of it open.
  [[nodiscard]] float full_color() const {
    return step_ == 1 ? static_cast<float>(levels_.saturated) - kGreyNoise : kClippedColor - kColorNoise;
  }
  /// The level of a brightness, 0 to 255.
  [[nodiscard]] float level_of(float brightness) const {
    return step_ == 1 ? brightness : kBlack + brightness / kWhitePerLevel;
  }

 private:
  [[nodiscard]] Shown shown(const std::uint8_t* row, std::ptrdiff_t column) const {
    const auto level = static_cast<float>(row[column * step_]);
    if (step_ == 1) return {level, level};
    const std::uint8_t* pair = row + column / 2 * 4;
    const float u = static_cast<float>(pair[1]) - 128.0F;
    const float v = static_cast<float>(pair[3]) - 128.0F;
    const float most = std::max({1.596F * v, -0.392F * u - 0.813F * v, 2.017F * u});
    const float brightness = kWhitePerLevel * (level - kBlack);
    return {brightness, brightness + most};
  }
  [[nodiscard]] bool is_clipped(const std::uint8_t* row, std::ptrdiff_t column) const {
    if (step_ == 1) return row[column] >= levels_.saturated;
    return shown(row, column).brightest_color >= kClippedColor;
  }

  static constexpr float kGreyNoise = 2.5F;
  static constexpr float kColorNoise = 4.0F;
  static constexpr float kMinClippedLevel = 170.0F;
  static constexpr float kBlack = 16.0F;  // of YUYV
  static constexpr float kWhitePerLevel = 1.164F;
  static constexpr float kClippedColor = 250.0F;  // of 255: chroma is shared by two pixels, and noisy

  const std::uint8_t* data_;
  std::ptrdiff_t stride_;
  int step_;
  int width_;
  int height_;
  LightLevels levels_;
};

}  // namespace cgsr::illumination
