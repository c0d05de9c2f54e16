#pragma once

#include <memory>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "platform/error.h"

namespace cgsr::app {

class VideoWriter {
 public:
  static Result<VideoWriter> create(const std::string& path, cv::Size size, double rate_hz);
  Result<void> add(const cv::Mat& picture);

 private:
  std::unique_ptr<cv::VideoWriter> writer_;
};

}  // namespace cgsr::app
