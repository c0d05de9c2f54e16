#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cgsr::shade {

/// Grows masks of bytes, a bit a cell inside: a step costs a few instructions for 64 cells. This is dilation (Serra 1982), for the masks of
/// shaded regions (5.2). Masks lie row by row.
class MaskGrowth {
 public:
  /// Steps that grow() can tell apart.
  static constexpr int kMost = 7;

  MaskGrowth(int width, int height);

  /// Every cell that is not 0 grows by `cells` in every direction, corners too. \param mask  a byte a cell, 0 or 255 afterwards.
  void grow_square(std::uint8_t* mask, int cells);

  /// Every cell grows by the number of its highest bit, about as a disc does; cells that are 0 do not.
  /// \param mask  a byte a cell, 0 or 255 afterwards.
  void grow(std::uint8_t* mask);

 private:
  void clear();
  void take(const std::uint8_t* mask, std::uint8_t bits);
  void step(bool corners);
  void write(std::uint8_t* mask) const;

  int width_;
  int height_;
  std::size_t words_;  ///< of a row.
  std::vector<std::uint64_t> cells_;
  std::vector<std::uint64_t> grown_;
  std::vector<std::uint64_t> sideways_;  ///< grown to the left and right alone.
};

}  // namespace cgsr::shade
