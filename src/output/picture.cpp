#include "src/output/picture.h"

#include <fmt/core.h>
#include <opencv2/imgcodecs.hpp>

namespace cgsr::app {

Result<cv::Mat> read_picture(const std::string& file, const geometry::Camera& camera, const std::string& camera_file) {
  cv::Mat picture;
  try {
    picture = cv::imread(file, cv::IMREAD_COLOR);
  } catch (const cv::Exception& wrong) {  // such as a header with a size beyond what it takes
    return fail(fmt::format("{}: cannot be read as an image: {}", file, wrong.err));
  }
  if (picture.empty()) return fail(fmt::format("{}: no image that can be read", file));
  if (picture.cols != camera.width_px || picture.rows != camera.height_px) {
    return fail(fmt::format("{}: {}x{} px, but {} is of a camera of {}x{}", file, picture.cols, picture.rows,
                            camera_file, camera.width_px, camera.height_px));
  }
  return picture;
}

Result<void> write_picture(const std::string& file, const cv::Mat& picture) {
  try {
    if (cv::imwrite(file, picture)) return {};
  } catch (const cv::Exception&) {  // an ending that it does not know
  }
  return fail(fmt::format("{}: cannot be written as an image", file));
}

}  // namespace cgsr::app
