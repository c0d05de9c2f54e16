#include "src/sinks/pose_truth.h"

#include <algorithm>
#include <cmath>

namespace cgsr::sinks {
namespace {

geometry::Pose true_camera(const hal::ImageTruth& truth) {
  geometry::Pose X_WC = geometry::Pose::Identity();
  const auto& q = truth.camera_wxyz;
  X_WC.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  X_WC.translation() = Eigen::Vector3d(truth.camera_m[0], truth.camera_m[1], truth.camera_m[2]);
  return X_WC;
}

}  // namespace

double Streak::add(bool is_so, MonoTime stamp) {
  if (is_so && !since_) since_ = stamp;
  if (since_) longest_s_ = std::max(longest_s_, to_seconds(stamp - *since_));
  if (!is_so) since_.reset();
  return longest_s_;
}

std::optional<PoseError> PoseTruth::add(const hal::ImageTruth& truth, const stages::PoseEstimate& pose,
                                        const hal::Odometry& odometry) {
  if (!pose.has_map) return std::nullopt;
  if (statistics_.images == 0 && !pose.camera.correction.corrected) return std::nullopt;
  if (statistics_.images == 0) statistics_.first_s = to_seconds(truth.stamp.time_since_epoch());
  follow_odometry(truth.robot, odometry);
  const bool lost = pose.camera.state == localization::TrackState::kLost;
  statistics_.longest_lost_s = lost_.add(lost || pose.seeks_pose(), truth.stamp);
  if (pose.seeks_pose()) {
    ++statistics_.searching;
    statistics_.longest_wrong_s = wrong_.add(false, truth.stamp);
    return std::nullopt;
  }
  const geometry::Vector6d error = geometry::step_between(true_camera(truth), pose.camera.X_WC);
  const PoseError off{error.head<3>().norm(), error.tail<3>().norm()};
  const auto n = static_cast<double>(++statistics_.images);
  statistics_.corrected += pose.camera.correction.corrected ? 1 : 0;
  statistics_.mean_m += (off.position_m - statistics_.mean_m) / n;
  statistics_.mean_rad += (off.direction_rad - statistics_.mean_rad) / n;
  if (off.position_m > statistics_.worst_m) {
    statistics_.worst_m = off.position_m;
    statistics_.worst_s = to_seconds(truth.stamp.time_since_epoch());
  }
  statistics_.worst_rad = std::max(statistics_.worst_rad, off.direction_rad);
  const bool accurate = off.position_m < kAccurate_m && off.direction_rad < kAccurate_rad;
  statistics_.accurate += accurate ? 1 : 0;
  const bool claims = !lost && pose.camera.state != localization::TrackState::kUnsure;
  statistics_.longest_wrong_s = wrong_.add(claims && !accurate, truth.stamp);
  statistics_.lost += lost && state_ != localization::TrackState::kLost ? 1 : 0;
  state_ = pose.camera.state;
  return off;
}

void PoseTruth::follow_odometry(const hal::FloorPose& robot, const hal::Odometry& odometry) {
  const geometry::Pose X_WR = geometry::pose_on_floor(robot.x_m, robot.y_m, robot.heading_rad);
  const geometry::Pose X_OR = geometry::pose_on_floor(odometry.x_m, odometry.y_m, odometry.heading_rad);
  if (!X_WO_) X_WO_ = X_WR * X_OR.inverse();
  if (last_) statistics_.way_m += std::hypot(robot.x_m - last_->x_m, robot.y_m - last_->y_m);
  last_ = robot;
  statistics_.odometry_ends_off_m = (*X_WO_ * X_OR.translation() - X_WR.translation()).norm();
  statistics_.odometry_worst_m = std::max(statistics_.odometry_worst_m, statistics_.odometry_ends_off_m);
}

}  // namespace cgsr::sinks
