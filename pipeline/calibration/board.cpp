#include "pipeline/calibration/board.h"

#include <algorithm>
#include <charconv>

#include <fmt/core.h>
#include <opencv2/calib3d.hpp>

namespace cgsr::calibration {
namespace {

constexpr int kMostCorners = 50;

/// Grey in the middle of the square between the four corners from (column, row) on.
double grey_of_square(const cv::Mat& grey, const Board& board, const std::vector<cv::Point2f>& corners, int column,
                      int row) {
  const auto corner = [&](int c, int r) { return corners[static_cast<std::size_t>(r * board.columns + c)]; };
  const cv::Point2f middle =
      0.25F * (corner(column, row) + corner(column + 1, row) + corner(column, row + 1) + corner(column + 1, row + 1));
  const int x = std::clamp(cvRound(middle.x), 0, grey.cols - 1);
  const int y = std::clamp(cvRound(middle.y), 0, grey.rows - 1);
  return static_cast<double>(grey.at<std::uint8_t>(y, x));
}

}  // namespace

std::vector<cv::Point3f> Board::points() const {
  std::vector<cv::Point3f> out;
  out.reserve(static_cast<std::size_t>(columns * rows));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      out.emplace_back(static_cast<float>(column * square_m), static_cast<float>(row * square_m), 0.0F);
    }
  }
  return out;
}

Result<Board> parse_board(const std::string& text, double square_m) {
  Board board;
  board.square_m = square_m;
  const char* end = text.data() + text.size();
  const auto columns = std::from_chars(text.data(), end, board.columns);
  const bool by = columns.ec == std::errc() && columns.ptr != end && *columns.ptr == 'x';
  const auto rows =
      by ? std::from_chars(columns.ptr + 1, end, board.rows) : std::from_chars_result{end, std::errc::invalid_argument};
  if (!by || rows.ec != std::errc() || rows.ptr != end || std::min(board.columns, board.rows) < 3 ||
      std::max(board.columns, board.rows) > kMostCorners) {
    return fail(fmt::format("'{}' is no board; expected inner corners as COLUMNSxROWS, 3 to {} each, such as 9x6", text,
                            kMostCorners));
  }
  return board;
}

std::optional<std::vector<cv::Point2f>> find_board(const cv::Mat& grey, const Board& board) {
  std::vector<cv::Point2f> corners;
  const cv::Size size(board.columns, board.rows);
  // The quick search needs a white margin around the squares. The exhaustive one, on the grey levels as they are, does without: dark
  // surroundings right beside the outer squares confuse the normalized image.
  const bool found = cv::findChessboardCornersSB(grey, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE) ||
                     cv::findChessboardCornersSB(grey, size, corners, cv::CALIB_CB_EXHAUSTIVE);
  if (!found) return std::nullopt;
  if (corners.size() != static_cast<std::size_t>(board.columns * board.rows)) return std::nullopt;
  // Counted so that x, y and the way away from the viewer are a right-handed frame.
  const auto corner = [&](int c, int r) { return corners[static_cast<std::size_t>(r * board.columns + c)]; };
  const cv::Point2f x = corner(board.columns - 1, 0) - corner(0, 0);
  const cv::Point2f y = corner(0, board.rows - 1) - corner(0, 0);
  if (x.x * y.y - x.y * y.x < 0.0F) {
    for (int row = 0; row < board.rows; ++row) {
      const auto begin = corners.begin() + row * board.columns;
      std::reverse(begin, begin + board.columns);
    }
  }
  if (board.has_one_frame() && grey_of_square(grey, board, corners, 0, 0) >
                                   grey_of_square(grey, board, corners, board.columns - 2, board.rows - 2)) {
    std::reverse(corners.begin(), corners.end());
  }
  return corners;
}

}  // namespace cgsr::calibration
