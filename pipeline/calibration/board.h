#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "platform/error.h"

namespace cgsr::calibration {

/// A chessboard. Its frame: origin at the first inner corner, x along the row of `columns` inner corners, y down the columns, z into the
/// board, away from who looks at it. When columns + rows is odd, the first corner is the one whose square towards the board's middle is
/// black, and there is one frame only. Ours: the dissertation takes its camera for calibrated.
struct Board {
  int columns = 9;  ///< inner corners in a row.
  int rows = 6;
  double square_m = 0.025;

  [[nodiscard]] std::vector<cv::Point3f> points() const;
  [[nodiscard]] bool has_one_frame() const { return (columns + rows) % 2 == 1; }
};

/// Reads `9x6`.
Result<Board> parse_board(const std::string& text, double square_m);

/// \return the inner corners, in the order of Board::points(), to a fraction of a pixel; nothing when not all of them are seen.
std::optional<std::vector<cv::Point2f>> find_board(const cv::Mat& grey, const Board& board);

}  // namespace cgsr::calibration
