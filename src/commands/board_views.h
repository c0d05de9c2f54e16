#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/calibration/board.h"
#include "pipeline/calibration/intrinsics.h"
#include "platform/error.h"

namespace CLI {
class App;
}

namespace cgsr::app {

/// Which board is looked for, in what, how often.
struct BoardOptions {
  std::string input;  ///< video, image folder or image.
  std::string board = "9x6";
  double square_m = 0.025;
  int every = 1;
  int most = 60;
};

/// Adds --board, --square, --every and --most; what --input is, the caller says.
void add_board_options(CLI::App& command, BoardOptions& options);

struct BoardViews {
  std::vector<calibration::BoardView> views;
  cv::Mat backdrop;  ///< the last image in which a board was seen, in colour.
  cv::Size size;
  int images = 0;
  int without = 0;
  int damaged = 0;
};

/// Looks for the board in every `every`-th image. \param only_new  leaves out views that show what another one showed.
Result<BoardViews> find_views(const BoardOptions& options, const calibration::Board& board, bool only_new);

/// All corners over the last image that shows a board: green where they were used, red where left out.
/// \param used  a flag for each view, or none: all were.
cv::Mat draw_corners(const BoardViews& found, const std::vector<bool>& used);

}  // namespace cgsr::app
