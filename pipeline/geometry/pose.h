#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace cgsr::geometry {

/// A rigid transform (the viewing transformation of 2.2; the camera pose X of 4.1): X_AB takes points from frame B to frame A (docs/frames.md).
using Pose = Eigen::Isometry3d;

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// \return the rotation by |w| radians about w (Rodrigues 1840).
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& w);

/// \return the rotation vector of R, its angle in [0, pi].
Eigen::Vector3d vector_of(const Eigen::Matrix3d& R);

/// Moves X_WC by a small step: the first three numbers move its origin, in W, metres; the last three turn it about its origin, a rotation vector
/// with axes parallel to W's, radians. Every covariance of a pose in this project is that of such a step.
Pose moved(const Pose& X_WC, const Vector6d& step);

/// \return the step that takes `from` to `to`: moved(from, step) = to.
Vector6d step_between(const Pose& from, const Pose& to);

/// \return a robot's pose on the floor, X_WR.
Pose pose_on_floor(double x_m, double y_m, double heading_rad);

/// \return the angle from W's x axis to R's, radians, positive to the left.
double heading_of(const Pose& X_WR);

/// \return how far R's x axis points below the horizon, radians.
double pitch_of(const Pose& X_WR);

/// The rotation brought back to an exact one, after many products.
Pose normalized(const Pose& X);

}  // namespace cgsr::geometry
