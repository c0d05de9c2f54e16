#pragma once

#include <string>
#include <vector>

#include "pipeline/calibration/board.h"
#include "pipeline/calibration/intrinsics.h"
#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "platform/error.h"

namespace cgsr::calibration {

/// The camera on the robot and how well that is known.
struct Mount {
  geometry::Pose X_RC = geometry::Pose::Identity();
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();    ///< standard errors along R's axes.
  Eigen::Vector3d sigma_rad = Eigen::Vector3d::Zero();  ///< about R's axes.
  double rms = 0.0;                                     ///< of what was fitted: pixels for boards, metres for poses.
  double rms_rad = 0.0;                                 ///< poses only.
  std::vector<double> view_rms;                         ///< per view or pair of poses: pixels, or metres.
};

/// Where a board lies flat on the floor, its pattern up. \param heading_rad  of its x axis, from the robot's x axis to the left.
geometry::Pose board_on_floor(double x_m, double y_m, double heading_rad);

/// From views of a board of which the pose in the robot's frame is known: the mount that brings its corners nearest to their pixels.
/// \param X_RB  as many as views.
/// \return or why not: a board that has two frames, no views, views that contradict each other (rms above 2 px).
Result<Mount> mount_from_boards(const std::vector<BoardView>& views, const std::vector<geometry::Pose>& X_RB,
                                const Board& board, const geometry::Camera& camera);

/// From camera poses in the map beside the odometry's poses at the same moments: X_WC = X_WO X_OR X_RC, where O lies on W's floor. Because
/// the floor is the map's, the camera's height follows although the robot never leaves it. Ours; the equation is that of (Shiu and Ahmad 1989).
/// \return or why not: fewer than 6 pairs, turns of less than 30 degrees in all, no way driven, or one circle (its middle turns with the camera's direction),
///         poses that contradict the odometry (RMS above 10 cm).
Result<Mount> mount_from_poses(const std::vector<geometry::Pose>& X_WC, const std::vector<geometry::Pose>& X_OR);

/// What robot files hold: [mount] with position_m and quaternion_wxyz.
std::string mount_as_toml(const Mount& mount);

}  // namespace cgsr::calibration
