// Writes what the fuzzers begin with: JPEG images of every chroma format, and calls of a base that runs well.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <turbojpeg.h>

#include "hal/v4l2/jpeg_to_yuyv.h"
#include "tests/fuzz/seeds.h"

namespace {

constexpr int kWidth_px = cgsr::test::kSeedWidth_px;
constexpr int kHeight_px = cgsr::test::kSeedHeight_px;

bool write(const std::filesystem::path& file, const void* data, std::size_t size) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream stream(file, std::ios::binary);
  stream.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  return stream.good();
}

// With the byte before it that chooses a second size; what does not decode is no beginning.
bool write_images(const std::filesystem::path& folder) {
  std::array<std::uint8_t, std::size_t{3} * kWidth_px * kHeight_px> rgb{};
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb.at(i) = static_cast<std::uint8_t>(7 * i);
  bool written = true;
  for (const int subsampling : {TJSAMP_444, TJSAMP_422, TJSAMP_420, TJSAMP_GRAY, TJSAMP_440, TJSAMP_411}) {
    const tjhandle encoder = tjInitCompress();
    unsigned char* jpeg = nullptr;
    unsigned long size = 0;
    std::vector<std::uint8_t> input{1};
    if (tjCompress2(encoder, rgb.data(), kWidth_px, 0, kHeight_px, TJPF_RGB, &jpeg, &size, subsampling, 80, 0) == 0)
      input.insert(input.end(), jpeg, jpeg + size);
    cgsr::hal::v4l2::JpegToYuyv decoder;
    std::vector<std::uint8_t> image(std::size_t{2} * kWidth_px * kHeight_px);
    const std::string problem = decoder.decode(std::span(input).subspan(1), kWidth_px, kHeight_px, image.data());
    if (!problem.empty()) std::fprintf(stderr, "chroma format %d: %s\n", subsampling, problem.c_str());
    written &= problem.empty() && write(folder / (std::to_string(subsampling) + ".jpg"), input.data(), input.size());
    tjFree(jpeg);
    tjDestroy(encoder);
  }
  return written;
}

}  // namespace

int main(int count, char** values) {
  if (count != 2) {
    std::fprintf(stderr, "usage: fuzz_seeds FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = values[1];
  // Forward and left, operation 0 (healthy sets) and how many; then arming, and driving (tests/fuzz/can_frames.cpp).
  const std::vector<std::uint8_t> calls{128, 128, 0,   60, 128, 128, 3,   200, 90, 0,
                                        100, 128, 128, 2,  200, 128, 128, 0,   60};
  const std::string text =
      "[v4l2]\nwidth_px = 640\nexposure_s = 0.01\nend_of_frame_offset_s = 0.02\n[rmp]\nhold_s = 0.1\nmax_refusals = "
      "3\n";
  const bool written = write_images(folder / "jpeg_images") &&
                       write(folder / "can_frames/drive", calls.data(), calls.size()) &&
                       write(folder / "configuration/devices.toml", text.data(), text.size());
  if (!written) std::fprintf(stderr, "%s: the seeds could not be written\n", values[1]);
  return written ? 0 : 1;
}
