#pragma once

#include <cstdint>

namespace cgsr::imaging {

/// A colour of the camera: sRGB-encoded, each channel in [0, 1].
struct Rgb {
  double r = 0.0;
  double g = 0.0;
  double b = 0.0;
};

/// BT.601 limited range (Y 16..235, U and V 16..240) to RGB, cut off at [0, 1].
///
///   R = 1.164 (Y - 16) + 1.596 (V - 128)
///   G = 1.164 (Y - 16) - 0.392 (U - 128) - 0.813 (V - 128)
///   B = 1.164 (Y - 16) + 2.017 (U - 128)          (all over 255)
Rgb rgb_of_yuv(double y, double u, double v);

/// What the camera would have sent for a colour, 0..255; not rounded. The inverse of rgb_of_yuv inside the gamut.
struct Yuv {
  double y = 16.0;
  double u = 128.0;
  double v = 128.0;
};
Yuv yuv_of_rgb(const Rgb& rgb);

/// A colour in 16 bits: 32 levels of Y, 45 of U and 45 of V as one number of mixed radix,
///
///   code = (level(Y) * 45 + level(U)) * 45 + level(V)   < 64800.
///
/// 45 and not a power of two: it uses up the 16 bits, and being odd it puts the neutral 128 at the centre of a level, so that a grey
/// stays grey and its noise does not flip between two levels. Steps are 8.0 of Y and 5.7 of U and V.
/// Ours: the dissertation (3.3.1) counts histograms of RGB.
inline constexpr int kYLevels = 32;
inline constexpr int kChromaLevels = 45;
inline constexpr int kColorCodes = kYLevels * kChromaLevels * kChromaLevels;

/// The code as the image pass forms it, from sums instead of means so that nothing is rounded twice.
/// \param y4  four luma values added (one value times four at full resolution), 0..1020.
/// \param u2, v2  two chroma values added (one value times two), 0..510.
constexpr std::uint16_t color_code(int y4, int u2, int v2) {
  const int u_level = u2 * kChromaLevels / 512;
  const int v_level = v2 * kChromaLevels / 512;
  return static_cast<std::uint16_t>((y4 / 32 * kChromaLevels + u_level) * kChromaLevels + v_level);
}

/// \return the colour in the middle of a code's range: the one colour that stands for all of them, at learning and in every image.
/// \param code  < kColorCodes.
Rgb rgb_of_code(std::uint16_t code);

}  // namespace cgsr::imaging
