#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "platform/parameters.h"

namespace cgsr::hal::v4l2 {

enum class StreamFormat : std::uint8_t { kYuyv, kMjpeg };
inline constexpr std::array kStreamFormatNames{Named<StreamFormat>{"yuyv", StreamFormat::kYuyv},
                                               Named<StreamFormat>{"mjpeg", StreamFormat::kMjpeg}};
constexpr std::string_view to_string(StreamFormat format) {
  return word_in(kStreamFormatNames, format);
}

/// A camera at a video device of this computer.
struct V4l2Parameters {
  std::string device = "/dev/video0";
  StreamFormat format = StreamFormat::kYuyv;
  int width_px = 640;
  int height_px = 480;
  double rate_hz = 30.0;
  double exposure_s = 0.0;
  int gain = -1;
  int white_balance_k = 4600;
  int power_line_hz = 0;
  double end_of_frame_offset_s = 0.025;
  double stall_s = 1.0;
  double reopen_wait_s = 0.5;
  int buffers = 6;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text(
        "device", self.device,
        "The camera: a device node, a link of /dev/v4l/by-id, or a camera's id as `cgsr devices` prints it. Only "
        "an id and such a link find a camera again that was plugged in elsewhere.");
    visit.choice("format", self.format, kStreamFormatNames,
                 "The format that the camera sends; mjpeg costs decoding and disturbs colours, yuyv needs more of the "
                 "cable.");
    visit.number("width_px", self.width_px, {16, 4096}, "px", "The width of the images, which must be even.");
    visit.number("height_px", self.height_px, {16, 4096}, "px", "The height of the images.");
    visit.number("rate_hz", self.rate_hz, {1.0, 240.0}, "Hz",
                 "The number of images per second that is requested; the camera's answer takes effect.");
    visit.number("exposure_s", self.exposure_s, {0.0, 0.5}, "s",
                 "The exposure time; 0 leaves it to the camera, whose colours then change with what it sees.");
    visit.number("gain", self.gain, {-1, 65535}, "1",
                 "The gain in the camera's own units; -1 leaves it to the camera.");
    visit.number("white_balance_k", self.white_balance_k, {0, 20000}, "K",
                 "The fixed colour temperature of the white balance; 0 leaves it to the camera, which spoils colour "
                 "tracking.");
    visit.number("power_line_hz", self.power_line_hz, {0, 60}, "Hz",
                 "The mains frequency that the camera suppresses the flicker of: 50 or 60; 0 keeps the camera's "
                 "setting.");
    visit.number("end_of_frame_offset_s", self.end_of_frame_offset_s, {0.0, 0.5}, "s",
                 "The time from the start of the exposure to the driver's stamp, subtracted when the driver stamps the "
                 "end of an image; it has to be measured.");
    visit.number("stall_s", self.stall_s, {0.2, 60.0}, "s",
                 "The stream is started again when no image came for this time.");
    visit.number("reopen_wait_s", self.reopen_wait_s, {0.05, 60.0}, "s",
                 "A camera that is unplugged is looked for this often.");
    visit.number("buffers", self.buffers, {4, 32}, "1", "The number of image buffers requested from the driver.");
  }
};

}  // namespace cgsr::hal::v4l2
