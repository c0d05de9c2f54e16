#include "src/output/video_writer.h"

#include <fmt/core.h>

namespace cgsr::app {

Result<VideoWriter> VideoWriter::create(const std::string& path, cv::Size size, double rate_hz) {
  VideoWriter writer;
  writer.writer_ = std::make_unique<cv::VideoWriter>(path, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), rate_hz, size);
  if (!writer.writer_->isOpened()) return fail(fmt::format("{}: the video cannot be written", path));
  return writer;
}

Result<void> VideoWriter::add(const cv::Mat& picture) {
  writer_->write(picture);
  return {};
}

}  // namespace cgsr::app
