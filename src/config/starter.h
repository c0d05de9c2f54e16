#pragma once

#include <string_view>

namespace cgsr::config {

/// \return a short commented robot's file to start from: a recording that is processed as fast as possible.
std::string_view recording_starter();

/// \return the same for a webcam of this computer.
std::string_view webcam_starter();

}  // namespace cgsr::config
