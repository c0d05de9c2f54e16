#include "pipeline/color/track/relight.h"

#include <algorithm>
#include <array>

#include "pipeline/imaging/color_code.h"

namespace cgsr::color {
namespace {

constexpr std::size_t kBlock = 64;  // pixels that are converted at once
using Channel = std::array<float, kBlock>;

float within_byte(float value) {
  return std::min(255.0F, std::max(0.0F, value));
}

// BT.601 limited range, as imaging::rgb_of_yuv and yuv_of_rgb, in units of 1/255.
void to_rgb(const Channel& y, const Channel& u, const Channel& v, const std::array<float, 3>& gain, Channel& r,
            Channel& g, Channel& b) {
  for (std::size_t i = 0; i < kBlock; ++i) {
    const float luma = 1.164384F * (y[i] - 16.0F);
    const float blue = u[i] - 128.0F;
    const float red = v[i] - 128.0F;
    r[i] = within_byte(gain[0] * within_byte(luma + 1.596027F * red));
    g[i] = within_byte(gain[1] * within_byte(luma - 0.391762F * blue - 0.812968F * red));
    b[i] = within_byte(gain[2] * within_byte(luma + 2.017232F * blue));
  }
}

void to_yuv(const Channel& r, const Channel& g, const Channel& b, Channel& y, Channel& u, Channel& v) {
  for (std::size_t i = 0; i < kBlock; ++i) {
    y[i] = 16.5F + 0.256788F * r[i] + 0.504129F * g[i] + 0.097906F * b[i];
    u[i] = 128.5F - 0.148223F * r[i] - 0.290993F * g[i] + 0.439216F * b[i];
    v[i] = 128.5F + 0.439216F * r[i] - 0.367788F * g[i] - 0.071427F * b[i];
  }
}

}  // namespace

void relight(std::span<std::uint8_t> y, std::span<std::uint8_t> u, std::span<std::uint8_t> v, const Light& gain) {
  const std::array<float, 3> gains{static_cast<float>(gain.r), static_cast<float>(gain.g), static_cast<float>(gain.b)};
  Channel luma{};
  Channel blue{};
  Channel red{};
  Channel r;
  Channel g;
  Channel b;
  for (std::size_t first = 0; first < y.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, y.size() - first);
    const std::uint8_t* const y_in = y.data() + first;
    const std::uint8_t* const u_in = u.data() + first;
    const std::uint8_t* const v_in = v.data() + first;
    for (std::size_t i = 0; i < count; ++i) {
      luma[i] = y_in[i];
      blue[i] = u_in[i];
      red[i] = v_in[i];
    }
    to_rgb(luma, blue, red, gains, r, g, b);
    to_yuv(r, g, b, luma, blue, red);
    const auto byte = [](float value) { return static_cast<std::uint8_t>(static_cast<int>(value)); };
    std::transform(luma.begin(), luma.begin() + static_cast<std::ptrdiff_t>(count),
                   y.begin() + static_cast<std::ptrdiff_t>(first), byte);
    std::transform(blue.begin(), blue.begin() + static_cast<std::ptrdiff_t>(count),
                   u.begin() + static_cast<std::ptrdiff_t>(first), byte);
    std::transform(red.begin(), red.begin() + static_cast<std::ptrdiff_t>(count),
                   v.begin() + static_cast<std::ptrdiff_t>(first), byte);
  }
}

}  // namespace cgsr::color
