#pragma once

#include <cstdint>

#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/imaging/color_code.h"
#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::person {

/// An image in which rectangles and markers are drawn.
struct Drawing {
  cv::Mat yuyv;

  Drawing(int width_px, int height_px, const imaging::Rgb& wall) : yuyv(height_px, width_px, CV_8UC2) {
    fill({0, 0, double(width_px), double(height_px)}, wall);
  }

  void fill(const Box& box, const imaging::Rgb& color) {
    const auto yuv = imaging::yuv_of_rgb(color);
    const auto byte = [](double value) { return static_cast<std::uint8_t>(value + 0.5); };
    const Box part = intersection(box, {0, 0, double(yuyv.cols), double(yuyv.rows)});
    for (int y = static_cast<int>(part.y); y < static_cast<int>(part.y + part.height); ++y) {
      for (int x = static_cast<int>(part.x); x < static_cast<int>(part.x + part.width); ++x)
        yuyv.at<cv::Vec2b>(y, x) = {byte(yuv.y), byte(x % 2 == 0 ? yuv.u : yuv.v)};
    }
  }

  /// Values of a pixel, drawn into the luma; what lies outside of the image is cut off.
  void paste(const cv::Mat& grey, int left, int top) {
    for (int y = 0; y < grey.rows; ++y) {
      for (int x = 0; x < grey.cols; ++x) {
        if (x + left < 0 || y + top < 0 || x + left >= yuyv.cols || y + top >= yuyv.rows) continue;
        yuyv.at<cv::Vec2b>(y + top, x + left) = {grey.at<std::uint8_t>(y, x), 128};
      }
    }
  }

  /// A marker with its white margin, a cell wide; its black square becomes `box`.
  void mark(int id, const Box& box) {
    const int side = static_cast<int>(box.width), margin = side / 6;
    cv::Mat square, sheet;
    cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50), id, side, square, 1);
    cv::copyMakeBorder(square, sheet, margin, margin, margin, margin, cv::BORDER_CONSTANT, cv::Scalar(255));
    sheet.convertTo(sheet, CV_8U, 190.0 / 255.0, 25.0);  // as a camera sees paper and ink
    paste(sheet, static_cast<int>(box.x) - margin, static_cast<int>(box.y) - margin);
  }

  /// What a camera does that moves sideways by so many pixels while it exposes.
  void blur(int length_px) {
    cv::Mat luma;
    cv::extractChannel(yuyv, luma, 0);
    cv::blur(luma, luma, {length_px, 1});
    cv::insertChannel(luma, yuyv, 0);
  }

  [[nodiscard]] ImageView view() const {
    return {yuyv.data, yuyv.cols, yuyv.rows, static_cast<std::ptrdiff_t>(yuyv.step), PixelFormat::kYuyv};
  }
};

}  // namespace cgsr::person
