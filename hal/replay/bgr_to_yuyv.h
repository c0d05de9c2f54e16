#pragma once

#include <cstddef>
#include <cstdint>

namespace cgsr::hal {

/// Converts packed 8-bit B G R to YUYV, BT.601 limited range, each value rounded to the nearest:
///
///   Y = 16  + ( 65.481 R + 128.553 G +  24.966 B) / 255          of either pixel
///   U = 128 + (-37.797 R -  74.203 G + 112.000 B) / 255          of the mean of the two pixels
///   V = 128 + (112.000 R -  93.786 G -  18.214 B) / 255          of the mean of the two pixels    (ITU-R BT.601)
///
/// \param width_px  even; rows lie `bgr_stride` and `yuyv_stride` bytes apart and do not overlap.
/// Cost: one pass in 32-bit integers, no allocation. The same bytes on every machine, which OpenCV's own conversion, picked
/// by instruction set, does not promise.
void bgr_to_yuyv(const std::uint8_t* bgr, std::ptrdiff_t bgr_stride, int width_px, int height_px, std::uint8_t* yuyv,
                 std::ptrdiff_t yuyv_stride);

}  // namespace cgsr::hal
