#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/v4l2/parameters.h"
#include "hal/v4l2/video_device.h"
#include "platform/error.h"

namespace cgsr::hal::v4l2 {

/// A size that a camera offers: one, or every step from min to max.
struct OfferedSize {
  int min_width_px = 0, max_width_px = 0, step_width_px = 1;
  int min_height_px = 0, max_height_px = 0, step_height_px = 1;
  std::vector<double> rates_hz;  ///< at the largest of these sizes, fastest first; empty: not said.

  [[nodiscard]] bool single() const { return min_width_px == max_width_px && min_height_px == max_height_px; }
  [[nodiscard]] bool holds(int width_px, int height_px) const;
};

struct OfferedFormat {
  std::uint32_t fourcc = 0;
  std::string name;  ///< the driver's words.
  std::vector<OfferedSize> sizes;
};

/// What a video device is.
struct DeviceFacts {
  std::string card;  ///< the camera's name.
  std::string driver;
  std::string bus;
  bool captures = false;  ///< it delivers images by streaming: else it is an output, or the metadata of a camera.
};

/// \param device  open. \return or the errno in words.
Result<DeviceFacts> facts_of(VideoDevice& device);

/// \param device  open. \return every format with its sizes and rates, as far as the driver says; bounded against drivers
/// whose lists never end.
std::vector<OfferedFormat> offered_formats(VideoDevice& device);

/// \return what the kernel calls it.
std::uint32_t fourcc_of(StreamFormat format);

/// \return the four letters, as v4l2-ctl prints them.
std::string fourcc_text(std::uint32_t fourcc);

/// \return e.g. "640x480", or "16x16 to 1920x1080 in steps of 2x2".
std::string to_string(const OfferedSize& size);

}  // namespace cgsr::hal::v4l2
