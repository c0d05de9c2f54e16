// Whatever a camera delivers for a JPEG image: decoded or refused, and nothing outside of the image is written.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "hal/v4l2/jpeg_to_yuyv.h"

namespace {

// Small, so that many images are tried; tests/fuzz/seeds.cpp writes images of this size.
constexpr int kWidth_px = 32;
constexpr int kHeight_px = 16;
constexpr std::size_t kSize = std::size_t{2} * kWidth_px * kHeight_px;
constexpr std::size_t kGuard = 64;
constexpr std::uint8_t kUntouched = 0xA5;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static cgsr::hal::v4l2::JpegToYuyv decoder;  // one for all images, as in the camera
  std::vector<std::uint8_t> image(kSize + kGuard, kUntouched);
  static_cast<void>(decoder.decode({data, size}, kWidth_px, kHeight_px, image.data()));
  const bool inside = std::all_of(image.begin() + static_cast<std::ptrdiff_t>(kSize), image.end(),
                                  [](std::uint8_t byte) { return byte == kUntouched; });
  if (!inside) std::abort();
  return 0;
}
