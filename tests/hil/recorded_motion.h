#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/can_bus.h"
#include "platform/error.h"
#include "platform/time.h"

namespace cgsr::hil {

/// What the base said of its motion in the run that the images are of (tap_plugin.cpp), said again at the same times: images and odometry of one drive.
class RecordedMotion {
 public:
  /// \param file  a line for each message, in the order of time: id (hexadecimal), nanoseconds since the run began, its 8 bytes (hexadecimal).
  /// \return or the file and the line that is wrong: what is no such line, or is earlier than the one before; a file without one.
  static Result<RecordedMotion> load(const std::string& file);

  /// Puts what was said last at this time of the recording in the place of the frame's bytes. Frames of other messages stay as they are.
  /// \param since_begin  does not run backwards.
  void replace(hal::CanFrame& frame, Duration since_begin);

 private:
  struct Said {
    Duration at{};
    std::array<std::uint8_t, 8> data{};
  };
  struct Message {
    std::uint16_t id = 0;
    std::vector<Said> said;
    std::size_t next = 0;
  };
  std::vector<Message> messages_;
};

}  // namespace cgsr::hil
