#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cgsr::hal::v4l2 {

/// Decodes a camera's JPEG images to YUYV, BT.601 limited range:
///
///   Y = 16 + 219 Y_j / 255,   C = 128 + 224 (C_j - 128) / 255     Y_j, C_j: full range, as JPEG has them (JFIF 1.02)
///
/// Whatever the bytes are, nothing outside the given memory is read or written.
class JpegToYuyv {
 public:
  JpegToYuyv();
  ~JpegToYuyv();
  JpegToYuyv(const JpegToYuyv&) = delete;
  JpegToYuyv& operator=(const JpegToYuyv&) = delete;

  /// \param yuyv  height_px rows of 2 width_px bytes. \param width_px  even.
  /// \return what is wrong with the image: cut, damaged, of another size; empty: decoded, whole. The first call with a
  /// chroma format allocates.
  std::string decode(std::span<const std::uint8_t> jpeg, int width_px, int height_px, std::uint8_t* yuyv);

 private:
  std::string shape(int subsampling, int width_px, int height_px);
  void pack(int width_px, int height_px, std::uint8_t* yuyv) const;

  void* decoder_;
  int subsampling_ = -1;
  int width_px_ = 0, height_px_ = 0;
  std::vector<std::uint8_t> planes_[3];
  int strides_[3] = {0, 0, 0};
};

}  // namespace cgsr::hal::v4l2
