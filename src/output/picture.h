#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "pipeline/geometry/camera.h"
#include "platform/error.h"

namespace cgsr::app {

/// \return an image in BGR. \param camera  of whose size it is to be. \param camera_file  its name, for the error's words.
Result<cv::Mat> read_picture(const std::string& file, const geometry::Camera& camera, const std::string& camera_file);

/// Of the kind that the file's ending says.
Result<void> write_picture(const std::string& file, const cv::Mat& picture);

}  // namespace cgsr::app
