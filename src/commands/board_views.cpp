#include "src/commands/board_views.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <CLI/CLI.hpp>
#include <opencv2/imgproc.hpp>

#include "src/commands/option_checks.h"
#include "src/input/image_input.h"

namespace cgsr::app {
namespace {

/// A view counts as new when its corners moved by so much of the image's width (mean) since every one that was taken.
constexpr float kNewView = 0.03F;

cv::Mat luma_of(const ImageView& image) {
  cv::Mat grey(image.height_px, image.width_px, CV_8U);
  const int step = image.format == PixelFormat::kYuyv ? 2 : 1;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) grey.at<std::uint8_t>(y, x) = image.row(y)[step * x];
  return grey;
}

bool is_new(const std::vector<calibration::BoardView>& views, const std::vector<cv::Point2f>& corners, int width) {
  const auto moved = [&](const calibration::BoardView& view) {
    float sum = 0.0F;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const cv::Point2f step = corners[i] - view.corners[i];
      sum += std::hypot(step.x, step.y);
    }
    return sum / static_cast<float>(corners.size()) >= kNewView * static_cast<float>(width);
  };
  return std::all_of(views.begin(), views.end(), moved);
}

}  // namespace

void add_board_options(CLI::App& command, BoardOptions& options) {
  command.add_option("--board", options.board, "the chessboard's inner corners, COLUMNSxROWS")->capture_default_str();
  command.add_option("--square", options.square_m, "side of a square in metres")
      ->check(in_range(1e-3, 1.0))
      ->capture_default_str();
  command.add_option("--every", options.every, "look at every n-th image only")->check(in_range(1, 1000000));
  command.add_option("--most", options.most, "views of the board to take at most")->check(in_range(1, 1000));
}

Result<BoardViews> find_views(const BoardOptions& options, const calibration::Board& board, bool only_new) {
  auto input = ImageInput::open({options.input, 0, 0, 0, 0});
  if (!input) return tl::unexpected(input.error());
  BoardViews out;
  for (int number = 0;; ++number) {
    const auto next = input->next();
    if (next.end) break;
    if (!next.image) {
      ++out.damaged;
      continue;
    }
    if (number % options.every != 0 || static_cast<int>(out.views.size()) >= options.most) continue;
    ++out.images;
    const cv::Mat grey = luma_of(next.image.view());
    out.size = grey.size();
    auto corners = calibration::find_board(grey, board);
    if (!corners) {
      ++out.without;
      continue;
    }
    if (only_new && !is_new(out.views, *corners, grey.cols)) continue;
    out.views.push_back({number, std::move(*corners)});
    cv::cvtColor(grey, out.backdrop, cv::COLOR_GRAY2BGR);
  }
  return out;
}

cv::Mat draw_corners(const BoardViews& found, const std::vector<bool>& used) {
  constexpr int kShift = 4;
  cv::Mat picture = found.backdrop.clone();
  for (std::size_t i = 0; i < found.views.size(); ++i) {
    const cv::Scalar color = used.empty() || used[i] ? cv::Scalar(60, 200, 60) : cv::Scalar(40, 40, 220);
    for (const cv::Point2f& corner : found.views[i].corners) {
      const cv::Point at(cvRound(16.0F * corner.x), cvRound(16.0F * corner.y));
      cv::circle(picture, at, 2 << kShift, color, 1, cv::LINE_AA, kShift);
    }
  }
  return picture;
}

}  // namespace cgsr::app
