#include "pipeline/calibration/marker.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace cgsr::calibration {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMinSide_px = 20.0;
constexpr double kMaxError_px = 1.0;  // of a corner, where the pose puts it
constexpr double kAmbiguous = 0.6;    // the second pose that a square allows fits this well against the first

/// Looking along the wall's normal, the marker's x runs to the right, its y down, its z into the wall.
geometry::Pose marker_in_world(const Marker& marker) {
  geometry::Pose X_WM = geometry::pose_on_floor(marker.x_m, marker.y_m, marker.facing_deg * kDegree);
  X_WM.translation().z() = marker.z_m;
  Eigen::Matrix3d axes;  // columns: x, y, z of the marker in a frame whose x looks out of the wall
  axes << 0.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  X_WM.linear() = X_WM.linear() * axes;
  return X_WM;
}

}  // namespace

std::optional<geometry::Pose> camera_by_marker(const Marker& marker, const geometry::Camera& camera,
                                               const cv::Mat& image) {
  if (marker.id < 0 || image.empty()) return std::nullopt;
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  auto parameters = cv::aruco::DetectorParameters::create();
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  cv::aruco::detectMarkers(image, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50), corners, ids, parameters);
  std::optional<std::size_t> seen;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] != marker.id) continue;
    if (seen) return std::nullopt;
    seen = i;
  }
  if (!seen || cv::contourArea(corners[*seen]) < kMinSide_px * kMinSide_px) return std::nullopt;

  const auto half = static_cast<float>(0.5 * marker.side_m);
  const std::vector<cv::Point3f> square{{-half, half, 0}, {half, half, 0}, {half, -half, 0}, {-half, -half, 0}};
  const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const cv::Vec<double, 5> lens(camera.k1, camera.k2, camera.p1, camera.p2, camera.k3);
  std::vector<cv::Vec3d> turns;
  std::vector<cv::Vec3d> places;
  std::vector<double> errors_px;
  const int found = cv::solvePnPGeneric(square, corners[*seen], K, lens, turns, places, false, cv::SOLVEPNP_IPPE_SQUARE,
                                        cv::noArray(), cv::noArray(), errors_px);
  if (found < 1 || errors_px.front() > kMaxError_px) return std::nullopt;
  if (found > 1 && errors_px[0] > kAmbiguous * errors_px[1]) return std::nullopt;
  // IPPE's square has y up and z towards the camera; ours has y down and z into the wall.
  Eigen::Matrix3d flip = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  geometry::Pose X_CM = geometry::Pose::Identity();
  X_CM.linear() = geometry::rotation_of({turns[0][0], turns[0][1], turns[0][2]}) * flip;
  X_CM.translation() = Eigen::Vector3d(places[0][0], places[0][1], places[0][2]);
  return marker_in_world(marker) * X_CM.inverse();
}

}  // namespace cgsr::calibration
