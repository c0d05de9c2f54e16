#include "pipeline/imaging/color_bins.h"

#include <algorithm>

namespace cgsr::imaging {
namespace {

// Hue, saturation and value, each in [0, 1]; the hue of 360 degrees is 0 again.
std::array<double, 3> hsv_of(const Rgb& c) {
  const double value = std::max({c.r, c.g, c.b});
  const double chroma = value - std::min({c.r, c.g, c.b});
  if (chroma <= 0.0) return {0.0, 0.0, value};
  double sector = 0.0;  // of six
  if (value == c.r) {
    sector = (c.g - c.b) / chroma;
  } else if (value == c.g) {
    sector = 2.0 + (c.b - c.r) / chroma;
  } else {
    sector = 4.0 + (c.r - c.g) / chroma;
  }
  if (sector < 0.0) sector += 6.0;
  return {sector < 6.0 ? sector / 6.0 : 0.0, chroma / value, value};
}

std::array<double, 3> channels_of(const ColorBins& bins, const Rgb& c) {
  switch (bins.space) {
    case ColorSpace::kHsv:
      return hsv_of(c);
    case ColorSpace::kYuv: {
      const auto yuv = yuv_of_rgb(c);
      const double half_bin = bins.per_channel % 2 == 0 ? 0.5 / bins.per_channel : 0.0;
      return {(yuv.y - 16.0) / 219.0, (yuv.u - 16.0) / 224.0 + half_bin, (yuv.v - 16.0) / 224.0 + half_bin};
    }
    case ColorSpace::kRgb:
      break;
  }
  return {c.r, c.g, c.b};
}

}  // namespace

int bin_of(const ColorBins& bins, const Rgb& rgb) {
  const Rgb inside{std::clamp(rgb.r, 0.0, 1.0), std::clamp(rgb.g, 0.0, 1.0), std::clamp(rgb.b, 0.0, 1.0)};
  int bin = 0;
  for (const double channel : channels_of(bins, inside)) {
    const int level = std::clamp(static_cast<int>(channel * bins.per_channel), 0, bins.per_channel - 1);
    bin = bin * bins.per_channel + level;
  }
  return bin;
}

}  // namespace cgsr::imaging
