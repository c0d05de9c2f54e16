#include "src/output/picture.h"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <opencv2/imgcodecs.hpp>

#include "platform/replace_file.h"
#include "src/output/picture_size.h"

namespace cgsr::app {
Result<cv::Mat> read_picture(const std::string& file, const geometry::Camera& camera, const std::string& camera_file) {
  const cv::Size expected(camera.width_px, camera.height_px);
  const auto differs = [&](cv::Size size) {
    return fail(fmt::format("{}: {}x{} px, but {} is of a camera of {}x{}", file, size.width, size.height, camera_file,
                            camera.width_px, camera.height_px));
  };
  const auto stated = size_in_header(file);
  if (!stated) return fail(fmt::format("{}: no image that can be read: expected PNG, JPEG, BMP or PNM", file));
  // Before it takes memory. A JPEG from a camera that was turned is turned back by the reader.
  if (*stated != expected && *stated != cv::Size(expected.height, expected.width)) return differs(*stated);
  cv::Mat picture;
  try {
    picture = cv::imread(file, cv::IMREAD_COLOR);
  } catch (const cv::Exception& wrong) {  // such as a header with a size beyond what it takes
    return fail(fmt::format("{}: cannot be read as an image: {}", file, wrong.err));
  }
  if (picture.empty()) return fail(fmt::format("{}: no image that can be read", file));
  if (picture.size() != expected) return differs(picture.size());
  return picture;
}

Result<void> write_picture(const std::string& file, const cv::Mat& picture) {
  std::vector<std::uint8_t> bytes;
  try {
    if (cv::imencode(std::filesystem::path(file).extension().string(), picture, bytes)) {
      return replace_file(file, {std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size())});
    }
  } catch (const cv::Exception&) {  // an ending that it does not know
  }
  return fail(fmt::format("{}: cannot be written as an image: expected a name that ends in .png or .jpg", file));
}

}  // namespace cgsr::app
