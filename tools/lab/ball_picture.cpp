#include "tools/lab/ball_picture.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace cgsr::lab {
namespace {

void draw_box(const std::optional<Box>& box, const cv::Scalar& color, cv::Mat& picture) {
  if (box) cv::rectangle(picture, cv::Rect2d(box->x, box->y, box->width, box->height), color, 2);
}

}  // namespace

Picture picture_of(const BallFilm::Shot& shot, const shade::ShadeMasks& masks, const std::optional<Box>& with,
                   const std::optional<Box>& without, const std::string& title) {
  cv::Mat drawn = shot.image.bgr.clone();
  for (int y = 0; y < drawn.rows; ++y) {
    for (int x = 0; x < drawn.cols; ++x) {
      const int cell = y * masks.height / drawn.rows * masks.width + x * masks.width / drawn.cols;
      auto& pixel = drawn.at<cv::Vec3b>(y, x);
      if (masks.possibly_shaded[static_cast<std::size_t>(cell)] != 0) pixel = pixel * 0.75 + cv::Vec3b(60, 15, 0);
    }
  }
  draw_box(without, {0, 220, 255}, drawn);
  draw_box(with, {0, 255, 0}, drawn);
  Picture picture{fmt::format("{}: with the mask green, without yellow; blue: may lie in shade", title), {}};
  cv::imencode(".jpg", drawn, picture.jpeg, {cv::IMWRITE_JPEG_QUALITY, 85});
  return picture;
}

}  // namespace cgsr::lab
