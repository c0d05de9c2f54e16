#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <opencv2/core.hpp>

#include "platform/error.h"
#include "platform/image_view.h"

namespace cgsr::lab {

/// One image in both forms that trackers take: ours the camera's YUYV, the peers BGR. Even width, the same pixels in both.
struct Image {
  cv::Mat bgr;                     ///< CV_8UC3
  std::vector<std::uint8_t> yuyv;  ///< BT.601 limited range, 2 bytes a pixel, rows without gap

  [[nodiscard]] ImageView view() const {
    return {yuyv.data(), bgr.cols, bgr.rows, 2 * static_cast<std::ptrdiff_t>(bgr.cols), PixelFormat::kYuyv};
  }
};

/// Takes a BGR picture (CV_8UC3) as if a YUYV camera had seen it; an odd last column falls away. The BGR side keeps its full
/// chroma: the peers get the better picture.
Image image_of_bgr(const cv::Mat& bgr);

/// Takes what a camera delivers; the BGR side is decoded from it. \param yuyv  2 * width_px * height_px bytes, width even.
Image image_of_yuyv(std::vector<std::uint8_t> yuyv, int width_px, int height_px);

/// \return the picture file, or its name where it cannot be read.
Result<Image> load_image(const std::filesystem::path& path);

}  // namespace cgsr::lab
