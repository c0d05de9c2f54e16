#include "hal/replay/bgr_to_yuyv.h"

namespace cgsr::hal {
namespace {

// 2^20 keeps the sum of two pixels times a weight below 2^29, and the error of three rounded weights below 4e-4 of a step.
constexpr int kShift = 20;

constexpr std::int32_t fixed(double weight) {
  const double scaled = weight / 255.0 * (1 << kShift);
  return static_cast<std::int32_t>(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
}

constexpr std::int32_t kYR = fixed(65.481), kYG = fixed(128.553), kYB = fixed(24.966);
constexpr std::int32_t kUR = fixed(-37.797), kUG = fixed(-74.203), kUB = fixed(112.0);
constexpr std::int32_t kVR = fixed(112.0), kVG = fixed(-93.786), kVB = fixed(-18.214);
static_assert(kUR + kUG + kUB == 0 && kVR + kVG + kVB == 0, "grey has neutral chroma");

constexpr std::int32_t kLumaBase = (16 << kShift) + (1 << (kShift - 1));
constexpr std::int32_t kChromaBase = (128 << (kShift + 1)) + (1 << kShift);  // of two pixels: one more bit

std::uint8_t luma(int b, int g, int r) {
  return static_cast<std::uint8_t>((kYR * r + kYG * g + kYB * b + kLumaBase) >> kShift);
}

}  // namespace

void bgr_to_yuyv(const std::uint8_t* bgr, std::ptrdiff_t bgr_stride, int width_px, int height_px, std::uint8_t* yuyv,
                 std::ptrdiff_t yuyv_stride) {
  for (int y = 0; y < height_px; ++y, bgr += bgr_stride, yuyv += yuyv_stride) {
    const std::uint8_t* in = bgr;
    std::uint8_t* out = yuyv;
    for (int pair = 0; pair < width_px / 2; ++pair, in += 6, out += 4) {
      const int b = in[0] + in[3];
      const int g = in[1] + in[4];
      const int r = in[2] + in[5];
      out[0] = luma(in[0], in[1], in[2]);
      out[1] = static_cast<std::uint8_t>((kUR * r + kUG * g + kUB * b + kChromaBase) >> (kShift + 1));
      out[2] = luma(in[3], in[4], in[5]);
      out[3] = static_cast<std::uint8_t>((kVR * r + kVG * g + kVB * b + kChromaBase) >> (kShift + 1));
    }
  }
}

}  // namespace cgsr::hal
