#include "hal/v4l2/formats.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace cgsr::hal::v4l2 {
namespace {

constexpr std::uint32_t kMaxEntries = 128;  // of any list: a driver whose list does not end is not believed

template <std::size_t Size>
std::string text_of(const std::uint8_t (&bytes)[Size]) {
  const auto* end = std::find(std::begin(bytes), std::end(bytes), std::uint8_t{0});
  return {std::begin(bytes), end};
}

double rate_of(const v4l2_fract& interval) {
  return interval.numerator == 0 ? 0.0 : static_cast<double>(interval.denominator) / interval.numerator;
}

std::vector<double> rates_of(VideoDevice& device, std::uint32_t fourcc, int width_px, int height_px) {
  std::vector<double> rates;
  for (std::uint32_t i = 0; i < kMaxEntries; ++i) {
    v4l2_frmivalenum entry{};
    entry.index = i;
    entry.pixel_format = fourcc;
    entry.width = static_cast<std::uint32_t>(width_px);
    entry.height = static_cast<std::uint32_t>(height_px);
    if (device.control(VIDIOC_ENUM_FRAMEINTERVALS, &entry) != 0) break;
    if (entry.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      rates.push_back(rate_of(entry.discrete));
      continue;
    }
    rates.push_back(rate_of(entry.stepwise.min));
    rates.push_back(rate_of(entry.stepwise.max));
    break;
  }
  std::sort(rates.begin(), rates.end(), std::greater<>());
  return rates;
}

OfferedSize size_of(const v4l2_frmsizeenum& entry) {
  OfferedSize size;
  if (entry.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
    size.min_width_px = size.max_width_px = static_cast<int>(entry.discrete.width);
    size.min_height_px = size.max_height_px = static_cast<int>(entry.discrete.height);
    return size;
  }
  const auto& steps = entry.stepwise;
  size.min_width_px = static_cast<int>(steps.min_width);
  size.max_width_px = static_cast<int>(steps.max_width);
  size.step_width_px = std::max(1, static_cast<int>(steps.step_width));
  size.min_height_px = static_cast<int>(steps.min_height);
  size.max_height_px = static_cast<int>(steps.max_height);
  size.step_height_px = std::max(1, static_cast<int>(steps.step_height));
  return size;
}

std::vector<OfferedSize> sizes_of(VideoDevice& device, std::uint32_t fourcc) {
  std::vector<OfferedSize> sizes;
  for (std::uint32_t i = 0; i < kMaxEntries; ++i) {
    v4l2_frmsizeenum entry{};
    entry.index = i;
    entry.pixel_format = fourcc;
    if (device.control(VIDIOC_ENUM_FRAMESIZES, &entry) != 0) break;
    OfferedSize size = size_of(entry);
    size.rates_hz = rates_of(device, fourcc, size.max_width_px, size.max_height_px);
    sizes.push_back(std::move(size));
    if (entry.type != V4L2_FRMSIZE_TYPE_DISCRETE) break;  // a range is the only entry
  }
  return sizes;
}

}  // namespace

bool OfferedSize::holds(int width_px, int height_px) const {
  return width_px >= min_width_px && width_px <= max_width_px && (width_px - min_width_px) % step_width_px == 0 &&
         height_px >= min_height_px && height_px <= max_height_px && (height_px - min_height_px) % step_height_px == 0;
}

Result<DeviceFacts> facts_of(VideoDevice& device) {
  v4l2_capability capability{};
  if (const int error = device.control(VIDIOC_QUERYCAP, &capability); error != 0) {
    return fail(fmt::format("no video device ({})", error_words(error)));
  }
  const std::uint32_t can =
      (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? capability.device_caps : capability.capabilities;
  return DeviceFacts{.card = text_of(capability.card),
                     .driver = text_of(capability.driver),
                     .bus = text_of(capability.bus_info),
                     .captures = (can & V4L2_CAP_VIDEO_CAPTURE) != 0 && (can & V4L2_CAP_STREAMING) != 0};
}

std::vector<OfferedFormat> offered_formats(VideoDevice& device) {
  std::vector<OfferedFormat> formats;
  for (std::uint32_t i = 0; i < kMaxEntries; ++i) {
    v4l2_fmtdesc entry{};
    entry.index = i;
    entry.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (device.control(VIDIOC_ENUM_FMT, &entry) != 0) break;
    formats.push_back({entry.pixelformat, text_of(entry.description), sizes_of(device, entry.pixelformat)});
  }
  return formats;
}

std::uint32_t fourcc_of(StreamFormat format) {
  return format == StreamFormat::kYuyv ? V4L2_PIX_FMT_YUYV : V4L2_PIX_FMT_MJPEG;
}

std::string fourcc_text(std::uint32_t fourcc) {
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    const auto letter = static_cast<char>((fourcc >> shift) & 0x7F);
    text += letter >= ' ' && letter < 127 ? letter : '?';
  }
  return text;
}

std::string to_string(const OfferedSize& size) {
  if (size.single()) return fmt::format("{}x{}", size.min_width_px, size.min_height_px);
  return fmt::format("{}x{} to {}x{} in steps of {}x{}", size.min_width_px, size.min_height_px, size.max_width_px,
                     size.max_height_px, size.step_width_px, size.step_height_px);
}

}  // namespace cgsr::hal::v4l2
