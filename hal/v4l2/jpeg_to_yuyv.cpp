#include "hal/v4l2/jpeg_to_yuyv.h"

#include <array>
#include <string_view>

#include <fmt/format.h>
#include <turbojpeg.h>

namespace cgsr::hal::v4l2 {
namespace {

constexpr std::uint8_t limited_luma(int full) {
  return static_cast<std::uint8_t>(16 + (219 * full + 127) / 255);
}
constexpr std::uint8_t limited_chroma(int full) {
  const int scaled = 224 * (full - 128);
  return static_cast<std::uint8_t>(128 + (scaled >= 0 ? scaled + 127 : scaled - 127) / 255);
}

template <class Function>
constexpr std::array<std::uint8_t, 256> table(Function function) {
  std::array<std::uint8_t, 256> values{};
  for (int i = 0; i < 256; ++i) values[static_cast<std::size_t>(i)] = function(i);
  return values;
}
constexpr auto kLuma = table(limited_luma);
constexpr auto kChroma = table(limited_chroma);

/// How many luma samples a chroma sample stands for.
struct ChromaStep {
  int x = 1;
  int y = 1;
};

ChromaStep chroma_step(int subsampling) {
  switch (subsampling) {
    case TJSAMP_422:
      return {2, 1};
    case TJSAMP_420:
      return {2, 2};
    case TJSAMP_440:
      return {1, 2};
    case TJSAMP_411:
      return {4, 1};
    default:
      return {1, 1};
  }
}

}  // namespace

JpegToYuyv::JpegToYuyv() : decoder_(tjInitDecompress()) {}
JpegToYuyv::~JpegToYuyv() {
  if (decoder_ != nullptr) tjDestroy(decoder_);
}

std::string JpegToYuyv::decode(std::span<const std::uint8_t> jpeg, int width_px, int height_px, std::uint8_t* yuyv) {
  if (decoder_ == nullptr) return "no memory for a JPEG decoder";
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int color_space = 0;
  if (tjDecompressHeader3(decoder_, jpeg.data(), jpeg.size(), &width, &height, &subsampling, &color_space) != 0) {
    return fmt::format("no JPEG ({})", tjGetErrorStr2(decoder_));
  }
  if (width != width_px || height != height_px) {
    return fmt::format("the JPEG is {}x{}, the stream {}x{}", width, height, width_px, height_px);
  }
  if (color_space != TJCS_YCbCr && color_space != TJCS_GRAY) return "the JPEG is neither YCbCr nor grey";
  if (auto problem = shape(subsampling, width_px, height_px); !problem.empty()) return problem;
  std::array<unsigned char*, 3> planes = {planes_[0].data(), planes_[1].data(), planes_[2].data()};
  if (tjDecompressToYUVPlanes(decoder_, jpeg.data(), jpeg.size(), planes.data(), width_px, strides_, height_px, 0) !=
      0) {
    const std::string_view said = tjGetErrorStr2(decoder_);
    const bool stray_bytes = tjGetErrorCode(decoder_) == TJERR_WARNING && said.find("extraneous") != said.npos;
    if (!stray_bytes) return fmt::format("damaged JPEG ({})", said);
  }
  pack(width_px, height_px, yuyv);
  return {};
}

std::string JpegToYuyv::shape(int subsampling, int width_px, int height_px) {
  if (subsampling == subsampling_ && width_px == width_px_ && height_px == height_px_) return {};
  if (subsampling < 0 || subsampling > TJSAMP_411) return "the JPEG has a chroma format that is not known";
  const int planes = subsampling == TJSAMP_GRAY ? 1 : 3;
  for (int i = 0; i < 3; ++i) {
    strides_[i] = i < planes ? tjPlaneWidth(i, width_px, subsampling) : 0;
    const int rows = i < planes ? tjPlaneHeight(i, height_px, subsampling) : 0;
    if (strides_[i] < 0 || rows < 0) return "the JPEG has an impossible size";
    planes_[i].resize(static_cast<std::size_t>(strides_[i]) * static_cast<std::size_t>(rows));
  }
  subsampling_ = subsampling;
  width_px_ = width_px;
  height_px_ = height_px;
  return {};
}

void JpegToYuyv::pack(int width_px, int height_px, std::uint8_t* yuyv) const {
  const ChromaStep step = chroma_step(subsampling_);
  const bool grey = subsampling_ == TJSAMP_GRAY;
  for (int y = 0; y < height_px; ++y) {
    const std::uint8_t* luma = planes_[0].data() + std::ptrdiff_t{y} * strides_[0];
    const std::uint8_t* u = grey ? nullptr : planes_[1].data() + std::ptrdiff_t{y / step.y} * strides_[1];
    const std::uint8_t* v = grey ? nullptr : planes_[2].data() + std::ptrdiff_t{y / step.y} * strides_[2];
    std::uint8_t* out = yuyv + std::ptrdiff_t{y} * 2 * width_px;
    for (int x = 0; x + 1 < width_px; x += 2, out += 4) {
      const int c = x / step.x;
      const int d = (x + 1) / step.x;  // the same sample unless chroma is as wide as luma
      out[0] = kLuma[luma[x]];
      out[1] = grey ? std::uint8_t{128} : kChroma[static_cast<std::size_t>((u[c] + u[d] + 1) / 2)];
      out[2] = kLuma[luma[x + 1]];
      out[3] = grey ? std::uint8_t{128} : kChroma[static_cast<std::size_t>((v[c] + v[d] + 1) / 2)];
    }
  }
}

}  // namespace cgsr::hal::v4l2
