#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace cgsr {

enum class PixelFormat : std::uint8_t {
  kYuyv,   ///< 4:2:2, bytes Y0 U Y1 V, BT.601 limited range (Y 16..235, U and V 16..240); the width is even.
  kGrey8,  ///< one byte of luma.
  kBgr24,  ///< three bytes, sRGB-encoded. Only for drawing, learning and files; never on the frame path.
};
constexpr std::string_view to_string(PixelFormat format) {
  switch (format) {
    case PixelFormat::kYuyv:
      return "yuyv";
    case PixelFormat::kGrey8:
      return "grey8";
    case PixelFormat::kBgr24:
      return "bgr24";
  }
  return "";
}

/// An image that lies elsewhere: never owns, never copies. Pixels count from 0 at the centre of the top-left pixel.
struct ImageView {
  const std::uint8_t* data = nullptr;
  int width_px = 0;
  int height_px = 0;
  std::ptrdiff_t stride_bytes = 0;
  PixelFormat format = PixelFormat::kYuyv;

  [[nodiscard]] const std::uint8_t* row(int y) const { return data + y * stride_bytes; }
  [[nodiscard]] bool empty() const { return data == nullptr || width_px <= 0 || height_px <= 0; }
};

/// Bytes of one pixel of a row (YUYV: on average).
constexpr int bytes_per_pixel(PixelFormat format) {
  return format == PixelFormat::kYuyv ? 2 : format == PixelFormat::kGrey8 ? 1 : 3;
}

}  // namespace cgsr
