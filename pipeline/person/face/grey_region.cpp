#include "pipeline/person/face/grey_region.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace cgsr::person {
namespace {

int type_of(PixelFormat format) {
  return format == PixelFormat::kYuyv ? CV_8UC2 : format == PixelFormat::kGrey8 ? CV_8UC1 : CV_8UC3;
}

cv::Mat luma_of(const cv::Mat& pixels) {
  cv::Mat luma;
  if (pixels.channels() == 3) {
    cv::cvtColor(pixels, luma, cv::COLOR_BGR2GRAY);
  } else if (pixels.channels() == 2) {
    cv::extractChannel(pixels, luma, 0);
  } else {
    luma = pixels;
  }
  return luma;
}

// The region at the image's own size. Empty: they do not meet.
cv::Mat luma_in(const ImageView& image, const Box& region) {
  if (intersection(region, {0, 0, double(image.width_px), double(image.height_px)}).empty()) return {};
  const int left = static_cast<int>(std::lround(region.x));
  const int top = static_cast<int>(std::lround(region.y));
  const int right = std::max(left + 1, static_cast<int>(std::lround(region.x + region.width)));
  const int bottom = std::max(top + 1, static_cast<int>(std::lround(region.y + region.height)));
  const int x0 = std::clamp(left, 0, image.width_px - 1);
  const int y0 = std::clamp(top, 0, image.height_px - 1);
  const int x1 = std::clamp(right, x0 + 1, image.width_px);
  const int y1 = std::clamp(bottom, y0 + 1, image.height_px);
  // OpenCV's header takes no pointer to constant pixels; nothing here writes through it.
  const cv::Mat all(image.height_px, image.width_px, type_of(image.format), const_cast<std::uint8_t*>(image.data),
                    static_cast<std::size_t>(image.stride_bytes));
  cv::Mat cut = luma_of(all(cv::Range(y0, y1), cv::Range(x0, x1)));
  if (x0 != left || y0 != top || x1 != right || y1 != bottom) {
    cv::Mat whole;
    cv::copyMakeBorder(cut, whole, std::max(0, y0 - top), std::max(0, bottom - y1), std::max(0, x0 - left),
                       std::max(0, right - x1), cv::BORDER_REPLICATE);
    cut = whole;
  }
  return cut;
}

GreyPatch scaled_to(const cv::Mat& luma, int width_px, int height_px, int method) {
  GreyPatch patch{width_px, height_px, std::vector<std::uint8_t>(static_cast<std::size_t>(width_px) * height_px)};
  cv::Mat scaled(height_px, width_px, CV_8UC1, patch.pixels.data());
  cv::resize(luma, scaled, scaled.size(), 0, 0, method);
  return patch;
}

bool is_to_be_cut(const ImageView& image, const Box& region, int width_px, int height_px) {
  return !image.empty() && !region.empty() && width_px > 0 && height_px > 0;
}

}  // namespace

GreyPatch grey_region(const ImageView& image, const Box& region, int width_px, int height_px) {
  if (!is_to_be_cut(image, region, width_px, height_px)) return {};
  const cv::Mat luma = luma_in(image, region);
  if (luma.empty()) return {};
  return scaled_to(luma, width_px, height_px, luma.cols > width_px ? cv::INTER_AREA : cv::INTER_LINEAR);
}

// Halves cost an instruction per pixel, means over any other number of pixels ten.
GreyPatch quick_grey_region(const ImageView& image, const Box& region, int width_px, int height_px) {
  if (!is_to_be_cut(image, region, width_px, height_px)) return {};
  cv::Mat luma = luma_in(image, region);
  if (luma.empty()) return {};
  while (luma.cols >= 2 * width_px && luma.rows >= 2 * height_px) {
    const cv::Size half(luma.cols / 2, luma.rows / 2);
    cv::Mat halved;
    cv::resize(luma(cv::Rect(0, 0, 2 * half.width, 2 * half.height)), halved, half, 0, 0, cv::INTER_AREA);
    luma = halved;
  }
  return scaled_to(luma, width_px, height_px, cv::INTER_LINEAR);
}

void stretch_contrast(GreyPatch& patch, double max_factor) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t value : patch.pixels) ++counts[value];
  const std::size_t cut_off = patch.pixels.size() / 500;
  std::size_t darkest = 0, brightest = counts.size() - 1;
  for (std::size_t below = counts[darkest]; below <= cut_off && darkest < brightest;) below += counts[++darkest];
  for (std::size_t above = counts[brightest]; above <= cut_off && brightest > darkest;) above += counts[--brightest];
  const double factor =
      std::min(max_factor, 255.0 / static_cast<double>(std::max<std::size_t>(1, brightest - darkest)));
  std::array<std::uint8_t, 256> stretched{};
  for (std::size_t value = darkest; value < stretched.size(); ++value) {
    stretched[value] = static_cast<std::uint8_t>(std::min(255.0, factor * static_cast<double>(value - darkest)));
  }
  for (std::uint8_t& value : patch.pixels) value = stretched[value];
}

GreyPatch equalized_locally(const ImageView& image) {
  constexpr double kClipLimit =
      4.0;  // of limits of 2 to 8 and 4 to 12 tiles: most drawn faces found, and no more that are none
  constexpr int kTiles = 8;
  const Box whole{0, 0, static_cast<double>(image.width_px), static_cast<double>(image.height_px)};
  GreyPatch grey = grey_region(image, whole, image.width_px, image.height_px);
  cv::Mat pixels(grey.height_px, grey.width_px, CV_8UC1, grey.pixels.data());
  cv::createCLAHE(kClipLimit, {kTiles, kTiles})->apply(pixels, pixels);
  return grey;
}

}  // namespace cgsr::person
