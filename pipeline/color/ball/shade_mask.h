#pragma once

#include <cstddef>
#include <cstdint>

namespace cgsr::color {

/// Where something may lie in shade (5.2, "possibly shaded"): a small mask that lies over the whole camera image. Never owns, never copies.
///
/// Cell (column, row) covers the pixels x with x * width / image width = column, rounded down, and y likewise: a mask of 160x120 over an
/// image of 640x480 has cells of 4x4 pixels. Any size does that is not larger than the image.
struct ShadeMaskView {
  const std::uint8_t* cells = nullptr;  ///< row by row; 0: surely lit, anything else: possibly shaded.
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;  ///< bytes from one row to the next; at least `width`.

  [[nodiscard]] bool empty() const { return cells == nullptr || width <= 0 || height <= 0; }
};

}  // namespace cgsr::color
