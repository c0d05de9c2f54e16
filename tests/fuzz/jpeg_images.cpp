// Whatever a camera delivers for a JPEG image: decoded or refused, and nothing outside of the image is written.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "hal/v4l2/jpeg_to_yuyv.h"
#include "tests/fuzz/seeds.h"

namespace {

constexpr std::size_t kGuard = 64;
constexpr std::uint8_t kUntouched = 0xA5;

void decode(cgsr::hal::v4l2::JpegToYuyv& decoder, std::span<const std::uint8_t> jpeg, int width_px, int height_px) {
  const std::size_t size = std::size_t{2} * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  std::vector<std::uint8_t> image(size + kGuard, kUntouched);
  static_cast<void>(decoder.decode(jpeg, width_px, height_px, image.data()));
  const bool inside = std::all_of(image.begin() + static_cast<std::ptrdiff_t>(size), image.end(),
                                  [](std::uint8_t byte) { return byte == kUntouched; });
  if (!inside) std::abort();
}

}  // namespace

// The first byte halves the expected size, so that it changes from image to image. libturbojpeg itself is Debian's, without sanitizers: what it writes is
// seen behind the image alone.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::span<const std::uint8_t> jpeg(data + 1, size - 1);
  cgsr::hal::v4l2::JpegToYuyv decoder;
  decode(decoder, jpeg, cgsr::test::kSeedWidth_px, cgsr::test::kSeedHeight_px);
  decode(decoder, jpeg, cgsr::test::kSeedWidth_px >> (data[0] % 4), cgsr::test::kSeedHeight_px >> (data[0] / 4 % 4));
  decode(decoder, jpeg, cgsr::test::kSeedWidth_px, cgsr::test::kSeedHeight_px);
  return 0;
}
