#include "pipeline/calibration/intrinsics.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <opencv2/calib3d.hpp>

#include "pipeline/geometry/quantile.h"

namespace cgsr::calibration {
namespace {

constexpr int kColumns = 6;
constexpr int kRows = 4;
constexpr double kOutlier = 3.0;

std::vector<double> rms_per_view(const cv::Mat& errors) {
  std::vector<double> out;
  out.reserve(errors.total());
  for (int i = 0; i < static_cast<int>(errors.total()); ++i) out.push_back(errors.at<double>(i));
  return out;
}

struct Solution {
  cv::Mat K = cv::Mat::eye(3, 3, CV_64F);
  cv::Mat distortion = cv::Mat::zeros(1, 5, CV_64F);
  cv::Mat sigma;
  std::vector<double> view_rms;
  double rms = 0.0;
  double tilt_rad = 0.0;  ///< greatest angle between two boards.
};

double max_tilt(const std::vector<cv::Mat>& turns) {
  std::vector<cv::Vec3d> normals;
  normals.reserve(turns.size());
  for (const cv::Mat& turn : turns) {
    cv::Mat R;
    cv::Rodrigues(turn, R);
    normals.emplace_back(R.at<double>(0, 2), R.at<double>(1, 2), R.at<double>(2, 2));
  }
  double min_cosine = 1.0;
  for (const cv::Vec3d& a : normals)
    for (const cv::Vec3d& b : normals) min_cosine = std::min(min_cosine, a.dot(b));
  return std::acos(std::clamp(min_cosine, -1.0, 1.0));
}

Solution solve(const std::vector<const BoardView*>& views, const Board& board, const cv::Size& size,
               bool third_radial) {
  const std::vector<std::vector<cv::Point3f>> places(views.size(), board.points());
  std::vector<std::vector<cv::Point2f>> corners;
  corners.reserve(views.size());
  for (const BoardView* view : views) corners.push_back(view->corners);
  Solution solution;
  cv::Mat errors;
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> places_C;
  solution.rms = cv::calibrateCamera(places, corners, size, solution.K, solution.distortion, turns, places_C,
                                     solution.sigma, cv::noArray(), errors, third_radial ? 0 : cv::CALIB_FIX_K3,
                                     {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-10});
  solution.view_rms = rms_per_view(errors);
  solution.tilt_rad = max_tilt(turns);
  return solution;
}

geometry::Camera camera_of(const cv::Size& size, double fx, double fy, double cx, double cy, const double* k) {
  geometry::Camera camera;
  camera.width_px = size.width;
  camera.height_px = size.height;
  camera.fx_px = fx;
  camera.fy_px = fy;
  camera.cx_px = cx;
  camera.cy_px = cy;
  camera.k1 = k[0];
  camera.k2 = k[1];
  camera.p1 = k[2];
  camera.p2 = k[3];
  camera.k3 = k[4];
  return camera;
}

}  // namespace

double coverage_of(const std::vector<BoardView>& views, const cv::Size& size, std::string* empty) {
  std::array<std::array<int, kColumns>, kRows> cells{};
  for (const BoardView& view : views) {
    for (const cv::Point2f& corner : view.corners) {
      const int column =
          std::clamp(static_cast<int>(corner.x * kColumns / static_cast<float>(size.width)), 0, kColumns - 1);
      const int row = std::clamp(static_cast<int>(corner.y * kRows / static_cast<float>(size.height)), 0, kRows - 1);
      ++cells[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    }
  }
  int filled = 0;
  std::array<int, 4> empty_of{};  // upper left, upper right, lower left, lower right
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const bool full = cells[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] > 0;
      filled += full ? 1 : 0;
      if (!full) ++empty_of[static_cast<std::size_t>(2 * (2 * row / kRows) + 2 * column / kColumns)];
    }
  }
  if (empty != nullptr) {
    constexpr std::array<const char*, 4> kNames = {"upper left", "upper right", "lower left", "lower right"};
    *empty = kNames[static_cast<std::size_t>(std::max_element(empty_of.begin(), empty_of.end()) - empty_of.begin())];
  }
  return static_cast<double>(filled) / (kColumns * kRows);
}

Result<Intrinsics> calibrate_intrinsics(const std::vector<BoardView>& views, const Board& board, const cv::Size& size,
                                        const IntrinsicsOptions& options) {
  if (static_cast<int>(views.size()) < options.min_views) {
    return fail(
        fmt::format("the board of {}x{} inner corners is seen whole in {} views; expected at least {}, from different "
                    "sides and distances",
                    board.columns, board.rows, views.size(), options.min_views));
  }
  Intrinsics result;
  std::string empty;
  result.coverage = coverage_of(views, size, &empty);
  if (result.coverage < options.min_coverage) {
    return fail(
        fmt::format("the boards cover {:.0f} % of the image; expected at least {:.0f} %: hold it also to the {}",
                    100.0 * result.coverage, 100.0 * options.min_coverage, empty));
  }
  std::vector<const BoardView*> taken;
  taken.reserve(views.size());
  for (const BoardView& view : views) taken.push_back(&view);
  Solution solution;
  try {
    solution = solve(taken, board, size, options.third_radial);
    result.view_rms_px = solution.view_rms;
    const double limit = kOutlier * geometry::quantile(solution.view_rms, 0.5);
    taken.clear();
    for (std::size_t i = 0; i < views.size(); ++i) {
      result.used.push_back(solution.view_rms[i] <= limit);
      if (result.used[i]) taken.push_back(&views[i]);
    }
    if (taken.size() < views.size()) solution = solve(taken, board, size, options.third_radial);
  } catch (const cv::Exception& wrong) {
    return fail(fmt::format("the boards fit no camera: {}", wrong.err));
  }
  const double* k = solution.distortion.ptr<double>();
  const double* s = solution.sigma.ptr<double>();  // fx fy cx cy k1 k2 p1 p2 k3 ...
  result.camera = camera_of(size, solution.K.at<double>(0, 0), solution.K.at<double>(1, 1), solution.K.at<double>(0, 2),
                            solution.K.at<double>(1, 2), k);
  result.sigma = camera_of(size, s[0], s[1], s[2], s[3], s + 4);
  result.rms_px = solution.rms;
  if (!(result.rms_px <= options.max_rms_px)) {
    return fail(
        fmt::format("corners lie {:.2f} px (RMS) off what any camera would show; expected at most {:.1f}: is the board "
                    "flat, and has it {}x{} inner corners?",
                    result.rms_px, options.max_rms_px, board.columns, board.rows));
  }
  // Boards that all face the camera alike leave open whether it is far away with a long lens; standard errors do not show that.
  const double focal_error = std::max(s[0] / result.camera.fx_px, s[1] / result.camera.fy_px);
  const double tilt_deg = solution.tilt_rad * 180.0 / CV_PI;
  if (!(focal_error <= options.max_focal_error) || tilt_deg < options.min_tilt_deg) {
    return fail(
        fmt::format("the focal length is known to {:.1f} % only, and the boards are tilted against each other by "
                    "{:.0f} degrees at most; expected {:.1f} % "
                    "and {:.0f} degrees: tilt the board by 20 to 45 degrees in several views, to all sides",
                    100.0 * focal_error, tilt_deg, 100.0 * options.max_focal_error, options.min_tilt_deg));
  }
  return result;
}

}  // namespace cgsr::calibration
