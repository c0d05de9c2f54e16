#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <opencv2/core.hpp>

#include "platform/error.h"

namespace cgsr::app {

/// Writes pictures into a video file that can be watched while it grows and after the program was killed: every picture is handed
/// to the operating system before add() returns, and no part of the file waits for an end that may never be written.
///
///   .avi, .mkv   motion JPEG: every picture stands alone; a killed program loses none
///   .mp4         H.264 (MPEG-4 where the encoder is missing) in fragments of half a second; a killed program loses the last one
///
/// Not for the frame path. One thread at a time.
class VideoWriter {
 public:
  /// Creates or overwrites the file. \param size of every picture; an odd last column or row is not written. \param rate_hz > 0.
  /// \return an error that names the path: its ending, its folder, permissions, no space.
  static Result<VideoWriter> create(const std::string& path, cv::Size size, double rate_hz);

  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;
  ~VideoWriter();  ///< closes; an error is lost then.

  /// Appends a picture, 8-bit B G R of the size that create() was told. \return an error when it could not be written, for
  /// instance because the disk is full. What was written before stays readable; after a failed write every call fails.
  Result<void> add(const cv::Mat& picture);

  /// Writes what is outstanding and the index, and closes the file. Idempotent. \return the first error of this writer.
  Result<void> close();

  [[nodiscard]] std::int64_t pictures() const;

 private:
  struct File;
  explicit VideoWriter(std::unique_ptr<File> file);
  std::unique_ptr<File> file_;
};

}  // namespace cgsr::app
