#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/calibration/board.h"
#include "pipeline/geometry/camera.h"
#include "platform/error.h"

namespace cgsr::calibration {

/// One image's corners, in the order of Board::points().
struct BoardView {
  int image = 0;  ///< its number in the input.
  std::vector<cv::Point2f> corners;
};

struct Intrinsics {
  geometry::Camera camera;
  geometry::Camera sigma;           ///< standard errors, in the same places.
  double rms_px = 0.0;              ///< distance of corner and model, over all that were used.
  std::vector<double> view_rms_px;  ///< per view, in the order of the views; also of the ones left out.
  std::vector<bool> used;           ///< per view: one whose residual is three times the median's is left out.
  double coverage = 0.0;            ///< share of the cells of a raster over the image in which a corner lies.
};

struct IntrinsicsOptions {
  int min_views = 8;
  double min_coverage = 0.6;
  double max_rms_px = 1.5;
  double max_focal_error = 0.01;  ///< standard error of the focal lengths over the focal lengths.
  double min_tilt_deg = 20.0;     ///< between the two boards that differ most.
  bool third_radial = false;      ///< k3 too: for wide lenses.
};

/// Share of the cells of a 6x4 raster that hold a corner. \param empty  receives words for the emptiest part, when given.
double coverage_of(const std::vector<BoardView>& views, const cv::Size& size, std::string* empty = nullptr);

/// Intrinsics and distortion from views of a board (Zhang 2000, by OpenCV).
/// \return or why not: too few views, a part of the image that no board came to, views too much alike to tell focal length from distance,
///         residuals that are no measurement errors (a wrong board).
Result<Intrinsics> calibrate_intrinsics(const std::vector<BoardView>& views, const Board& board, const cv::Size& size,
                                        const IntrinsicsOptions& options = {});

}  // namespace cgsr::calibration
