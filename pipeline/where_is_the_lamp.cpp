#include "pipeline/where_is_the_lamp.h"

namespace cgsr {

using illumination::LampStatus;
using illumination::ObservationStatus;

std::string_view reason_of(const LampSight& sight) {
  if (!sight.has_board) return "no probe board";
  if (sight.observation != ObservationStatus::kSeen) return illumination::name_of(sight.observation);
  if (sight.seen.status != LampStatus::kFound) return illumination::name_of(sight.seen.status);
  return sight.placed ? "" : "where the robot is is not known";
}

PlacedRobot robot_of(const geometry::Pose& X_WC, const geometry::Matrix6d& camera_covariance,
                     const geometry::Pose& X_CR) {
  PlacedRobot robot;
  robot.X_WR = X_WC * X_CR;
  // A turn about the camera's place moves the robot's by w x r.
  const Eigen::Vector3d r = robot.X_WR.translation() - X_WC.translation();
  geometry::Matrix6d J = geometry::Matrix6d::Identity();
  J.topRightCorner<3, 3>() << 0.0, r.z(), -r.y(), -r.z(), 0.0, r.x(), r.y(), -r.x(), 0.0;
  robot.covariance = J * camera_covariance * J.transpose();
  return robot;
}

LampSight WhereIsTheLamp::look(const ImageView& image, const PlacedRobot* robot) {
  LampSight sight;
  sight.has_board = true;
  const auto observation = observer_.observe(image);
  sight.observation = observation.status;
  const auto lamps = illumination::locate_lamps(observer_.board(), lamp_, observation);
  sight.seen.status = lamps.status;
  if (lamps.count > 0) sight.seen = lamps.lamp[0];
  sight.placed = robot != nullptr;
  if (robot != nullptr) sight.change = filter_.update(observation, robot->X_WR, robot->covariance);
  for (int i = 0; i < filter_.count(); ++i) {
    if (!filter_.lamp(i).steady) continue;
    if (!sight.known) sight.lamp = filter_.lamp(i);
    sight.known = true;
    ++sight.lamps;
  }
  return sight;
}

}  // namespace cgsr
