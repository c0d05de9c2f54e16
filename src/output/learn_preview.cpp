#include "src/output/learn_preview.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/core.h>
#include <opencv2/imgproc.hpp>

#include "src/output/overlay.h"

namespace cgsr::app {
namespace {

constexpr int kSampleHeight_px = 300;
constexpr int kTile_px = 84;
constexpr int kTilesPerRow = 9;
constexpr int kGap_px = 6;
const cv::Scalar kPaper(245, 245, 245);
const cv::Scalar kInk(40, 40, 40);

cv::Rect whole_pixels(const Box& box) {
  return {cvRound(box.x), cvRound(box.y), std::max(1, cvRound(box.width)), std::max(1, cvRound(box.height))};
}

cv::Mat draw_sample(const color::Sample& sample, const Box& window) {
  cv::Mat picture = to_bgr(sample.image);
  cv::rectangle(picture, whole_pixels(window), {80, 230, 80}, 2);
  cv::rectangle(picture, whole_pixels(sample.box), {230, 150, 60}, 1);
  cv::resize(picture, picture, {picture.cols * kSampleHeight_px / picture.rows, kSampleHeight_px}, 0, 0,
             cv::INTER_AREA);
  return picture;
}

/// The learned window of the first sample as it would look under `light`: texture = recorded / assumed light, times `light` (Eq. 3.1).
cv::Mat under_light(const color::SamplePatch& patch, const color::Light& light) {
  cv::Mat tile;
  const cv::Rect window = whole_pixels(patch.window) & cv::Rect(0, 0, patch.width_px, patch.height_px);
  to_bgr(patch.view())(window).convertTo(tile, CV_32FC3);
  cv::multiply(tile, cv::Scalar(light.b / patch.light.b, light.g / patch.light.g, light.r / patch.light.r), tile);
  const double scale = std::min(double{kTile_px} / tile.cols, double{kTile_px} / tile.rows);
  cv::resize(tile, tile, {}, scale, scale, cv::INTER_NEAREST);
  tile.convertTo(tile, CV_8UC3);
  return tile;
}

void write_words(cv::Mat& sheet, const std::string& words, int top_px) {
  const auto line_length = static_cast<std::size_t>(std::max(20, sheet.cols / 8));
  std::string rest = words;
  for (int line = 0; !rest.empty() && line < 4; ++line) {
    std::size_t end = std::min(rest.size(), line_length);
    if (end < rest.size()) {
      const std::size_t blank = rest.rfind(' ', end);
      if (blank != std::string::npos && blank > 0) end = blank;
    }
    cv::putText(sheet, rest.substr(0, end), {kGap_px, top_px + 18 * (line + 1)}, cv::FONT_HERSHEY_SIMPLEX, 0.42, kInk,
                1, cv::LINE_AA);
    rest.erase(0, std::min(rest.size(), end + 1));
  }
}

}  // namespace

cv::Mat draw_preview(std::span<const color::Sample> samples, const color::Learned& learned) {
  std::vector<cv::Mat> pictures;
  int width = kTilesPerRow * (kTile_px + kGap_px) + kGap_px;
  int samples_width = kGap_px;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    pictures.push_back(draw_sample(samples[i], learned.windows[i]));
    samples_width += pictures.back().cols + kGap_px;
  }
  width = std::max(width, samples_width);

  const auto& lights = learned.model.lights;
  const int rows = (static_cast<int>(lights.size()) + kTilesPerRow - 1) / kTilesPerRow;
  const int tiles_top = kSampleHeight_px + 2 * kGap_px;
  const int words_top = tiles_top + rows * (kTile_px + kGap_px);
  cv::Mat sheet(words_top + 84, width, CV_8UC3, kPaper);

  int left = kGap_px;
  for (const cv::Mat& picture : pictures) {
    picture.copyTo(sheet(cv::Rect({left, kGap_px}, picture.size())));
    left += picture.cols + kGap_px;
  }
  for (std::size_t i = 0; i < lights.size() && !learned.model.samples.empty(); ++i) {
    const cv::Mat tile = under_light(learned.model.samples.front(), lights[i]);
    const cv::Point corner(kGap_px + static_cast<int>(i % kTilesPerRow) * (kTile_px + kGap_px),
                           tiles_top + static_cast<int>(i / kTilesPerRow) * (kTile_px + kGap_px));
    tile.copyTo(sheet(cv::Rect(corner, tile.size())));
  }
  write_words(sheet, learned.message, words_top);
  return sheet;
}

}  // namespace cgsr::app
