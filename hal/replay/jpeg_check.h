#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace cgsr::hal {

/// Tells whether a JPEG is whole. OpenCV does not: what is missing of a truncated one comes out grey, as if it had been seen.
class JpegCheck {
 public:
  JpegCheck();
  ~JpegCheck();
  JpegCheck(const JpegCheck&) = delete;
  JpegCheck& operator=(const JpegCheck&) = delete;

  /// \return what is wrong with the file's bytes; empty when all of it decodes. Stray bytes between markers, which many
  /// cameras write, are nothing wrong.
  /// Cost: the entropy decoding, and an inverse DCT of the constant terms alone.
  std::string problem(const std::vector<std::uint8_t>& file);

 private:
  void* decoder_;
  std::vector<std::uint8_t> pixels_;  // of the eighth-size picture, kept for its memory
};

}  // namespace cgsr::hal
