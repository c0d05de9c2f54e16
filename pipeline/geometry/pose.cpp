#include "pipeline/geometry/pose.h"

#include <cmath>

namespace cgsr::geometry {

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  if (angle < 1e-12) {
    Eigen::Matrix3d small;
    small << 1.0, -w.z(), w.y(), w.z(), 1.0, -w.x(), -w.y(), w.x(), 1.0;
    return small;
  }
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

Eigen::Vector3d vector_of(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

Pose moved(const Pose& X_WC, const Vector6d& step) {
  Pose result;
  result.linear() = rotation_of(step.tail<3>()) * X_WC.linear();
  result.translation() = X_WC.translation() + step.head<3>();
  result.makeAffine();
  return result;
}

Vector6d step_between(const Pose& from, const Pose& to) {
  Vector6d step;
  step.head<3>() = to.translation() - from.translation();
  step.tail<3>() = vector_of(to.linear() * from.linear().transpose());
  return step;
}

Pose pose_on_floor(double x_m, double y_m, double heading_rad) {
  Pose X_WR = Pose::Identity();
  X_WR.linear() = Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X_WR.translation() = Eigen::Vector3d(x_m, y_m, 0.0);
  return X_WR;
}

double heading_of(const Pose& X_WR) {
  return std::atan2(X_WR.linear()(1, 0), X_WR.linear()(0, 0));
}

double pitch_of(const Pose& X_WR) {
  const auto forward = X_WR.linear().col(0);
  return std::atan2(-forward.z(), std::hypot(forward.x(), forward.y()));
}

Pose normalized(const Pose& X) {
  Pose result = X;
  result.linear() = Eigen::Quaterniond(X.linear()).normalized().toRotationMatrix();
  return result;
}

}  // namespace cgsr::geometry
