#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/camera.h"

namespace cgsr::hal {

/// A folder that lasts as long as the test.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

/// Image `index` of a recording made for a test: smooth colours, and its index as the grey of the top left quarter.
cv::Mat numbered_image(int index, cv::Size size);
/// \return the index that a delivered image carries (0..59), whatever compression did to it.
int number_of(const ImageView& view);

/// 00000.png and so on; `extension` as ".jpg".
void write_folder(const std::string& folder, int images, cv::Size size, const std::string& extension = ".png");
/// \param codec  four letters; motion JPEG where every image stands alone, "XVID" where most are differences to the one before.
void write_video(const std::string& path, int images, cv::Size size, double rate_hz = 25.0, bool color = true,
                 const std::string& codec = "MJPG");

std::string read_bytes(const std::string& path);
void write_bytes(const std::string& path, const std::string& bytes);
/// Cuts the file to a part of its length.
void truncate(const std::string& path, double part);

}  // namespace cgsr::hal
