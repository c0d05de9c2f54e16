#include "tools/lab/image.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/replay/bgr_to_yuyv.h"

namespace cgsr::lab {
Image image_of_bgr(const cv::Mat& bgr) {
  Image image{bgr.colRange(0, bgr.cols & ~1).clone(), {}};
  const cv::Mat& kept = image.bgr;
  image.yuyv.resize(2 * kept.total());
  hal::bgr_to_yuyv(kept.data, static_cast<std::ptrdiff_t>(kept.step), kept.cols, kept.rows, image.yuyv.data(),
                   2 * kept.cols);
  return image;
}

Image image_of_yuyv(std::vector<std::uint8_t> yuyv, int width_px, int height_px) {
  Image image{{}, std::move(yuyv)};
  cv::cvtColor(cv::Mat(height_px, width_px, CV_8UC2, image.yuyv.data()), image.bgr, cv::COLOR_YUV2BGR_YUY2);
  return image;
}

Result<Image> load_image(const std::filesystem::path& path) {
  const cv::Mat bgr = cv::imread(path.string(), cv::IMREAD_COLOR);
  if (bgr.cols < 2) return fail(fmt::format("{} is not a picture", path.string()));
  return image_of_bgr(bgr);
}

}  // namespace cgsr::lab
