#pragma once

#include <string>
#include <vector>

#include "hal/gpiod/line_access.h"
#include "hal/socketcan/can_interfaces.h"
#include "hal/v4l2/find_camera.h"
#include "hal/v4l2/video_device.h"

namespace cgsr::devices {

// What `cgsr devices` prints: what this computer has, and for each the lines of a robot's file that select it.

/// \param device  closed. \return formats, sizes and settings; empty when the node delivers no images.
std::string camera_text(const hal::v4l2::CameraNode& node, hal::v4l2::VideoDevice& device);

std::string can_text(const hal::socketcan::CanInterface& interface);

/// \return the lines by chip; a long run of lines without a name or a user is one line of the text.
std::string lines_text(const std::vector<hal::gpiod::ListedLine>& lines);

}  // namespace cgsr::devices
