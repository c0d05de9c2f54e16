#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "platform/error.h"

namespace cgsr::hal {

/// Longest side of an image that is replayed; more is a mistake or an attack, not a camera.
inline constexpr int kLongestSide_px = 8192;

enum class ReadOutcome { kImage, kRefused, kEnd };
std::string_view to_string(ReadOutcome outcome);

/// Images out of files, one after the other, as 8-bit B G R. No clock, no slots, no threads: the camera around it has them.
/// Nothing throws: what a library throws becomes kRefused.
class ImageSource {
 public:
  virtual ~ImageSource() = default;

  /// Decodes the next image; its pixels stay until the next call. kRefused: it is damaged or unreadable, problem() says how,
  /// and the next call goes on behind it. kEnd: there is no further one; problem() says so when more were announced.
  virtual ReadOutcome read(cv::Mat& bgr) = 0;

  /// Passes over the next image without looking at its pixels. kRefused as above, as far as it is noticed.
  virtual ReadOutcome skip() = 0;

  /// Back to the first image.
  virtual Result<void> rewind() = 0;

  /// \return what the file says about its rate, however odd; 0 when it says nothing.
  [[nodiscard]] virtual double claimed_rate_hz() const = 0;
  /// \return what went wrong in the last call, in words; empty when nothing did.
  [[nodiscard]] virtual const std::string& problem() const = 0;
  /// \return what whoever starts this should know, one sentence each.
  [[nodiscard]] virtual const std::vector<std::string>& notes() const = 0;
};

/// Opens a folder of images (read in the order of their names), one image file, or a video file.
/// \return or why not: nothing there, not readable, empty, without images, not a video.
Result<std::unique_ptr<ImageSource>> open_source(const std::string& path);

/// \return whether the name ends like an image file's: the ones that a folder is read for.
bool named_like_image(const std::string& file_name);

/// \param files  paths in the order of reading, at least one.
std::unique_ptr<ImageSource> open_images(std::vector<std::string> files);

/// \param path  an existing file. \return the source, or why the file is no video.
Result<std::unique_ptr<ImageSource>> open_video(const std::string& path);

/// Decodes one png, ppm, pgm, pbm, bmp, tif or webp, whatever its name. \return what is wrong with it, in words that name
/// it; empty when it was decoded, whole.
std::string read_image_file(const std::string& path, cv::Mat& bgr);

}  // namespace cgsr::hal
