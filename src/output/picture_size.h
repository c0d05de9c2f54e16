#pragma once

#include <optional>
#include <string>

#include <opencv2/core.hpp>

namespace cgsr::app {

/// Reads the size that the header of a PNG, JPEG, BMP or PNM file states, a few bytes of it; nothing is decoded.
/// \return none: the file cannot be read, is of another kind, or its header is cut short. A JPEG's is that before the camera's orientation
///         is applied.
std::optional<cv::Size> size_in_header(const std::string& file);

}  // namespace cgsr::app
