#include "hal/replay/jpeg_check.h"

#include <string_view>

#include <fmt/format.h>
#include <turbojpeg.h>

#include "hal/replay/image_source.h"

namespace cgsr::hal {

JpegCheck::JpegCheck() : decoder_(tjInitDecompress()) {}
JpegCheck::~JpegCheck() {
  if (decoder_ != nullptr) tjDestroy(decoder_);
}

std::string JpegCheck::problem(const std::vector<std::uint8_t>& file) {
  if (decoder_ == nullptr) return "no memory for a JPEG decoder";
  int width_px = 0;
  int height_px = 0;
  int subsampling = 0;
  int color_space = 0;
  if (tjDecompressHeader3(decoder_, file.data(), file.size(), &width_px, &height_px, &subsampling, &color_space) != 0 &&
      tjGetErrorCode(decoder_) == TJERR_FATAL) {
    return tjGetErrorStr2(decoder_);
  }
  if (width_px > kLongestSide_px || height_px > kLongestSide_px) {
    return fmt::format("{}x{} is larger than {} on a side", width_px, height_px, kLongestSide_px);
  }
  const tjscalingfactor eighth{1, 8};
  const int small_width_px = TJSCALED(width_px, eighth);
  const int small_height_px = TJSCALED(height_px, eighth);
  const int format = color_space == TJCS_CMYK || color_space == TJCS_YCCK ? TJPF_CMYK : TJPF_GRAY;
  const int pitch_bytes = small_width_px * tjPixelSize[format];
  pixels_.resize(static_cast<std::size_t>(pitch_bytes) * static_cast<std::size_t>(small_height_px));
  if (tjDecompress2(decoder_, file.data(), file.size(), pixels_.data(), small_width_px, pitch_bytes, small_height_px,
                    format, 0) == 0) {
    return {};
  }
  const std::string_view said = tjGetErrorStr2(decoder_);
  const bool stray_bytes = tjGetErrorCode(decoder_) == TJERR_WARNING && said.find("extraneous") != said.npos;
  return stray_bytes ? std::string{} : std::string{said};
}

}  // namespace cgsr::hal
