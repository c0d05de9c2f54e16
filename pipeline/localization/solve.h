#pragma once

#include <span>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/localization/correction.h"

namespace cgsr::localization {

/// One of the distances d1, d2 (4.1): a point of the map that should lie on a perceived line.
struct LineDistance {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitY();  ///< of the line, unit, in pixels of the camera without lens.
  double offset_px = 0.0;                             ///< normal . p on the line.
  double sigma_px = 1.0;
  double weight = 1.0;  ///< how sure it is that the line is the map's, 0..1: what it counts, however near it lies.
  bool end = false;     ///< along an edge, of its end: neither d1 nor d2, and no part of Solution::rms_px.
};

/// How the equation system is solved: as the dissertation does, or robustly.
struct SolverOptions {
  bool paper =
      false;      ///< Eq. 4.4 and 4.5: numeric Jacobian, lambda = 1, units proportional to the variance, one full step.
  int steps = 4;  ///< of Levenberg and Marquardt.
  double robust =
      2.0;  ///< Cauchy's constant in sigmas: further out a distance counts less and less; 0: all count alike.
};

/// The pose that solve() found. Its information is that of the step that geometry::moved() takes, per m^2 and rad^2, axes of W.
struct Solution {
  bool solved = false;  ///< false: fewer than three distances in front of the camera, or numbers that are none.
  geometry::Pose X_WC = geometry::Pose::Identity();
  geometry::Matrix6d data_information = geometry::Matrix6d::Zero();  ///< of the distances alone.
  geometry::Matrix6d information = geometry::Matrix6d::Zero();       ///< with the prior.
  double cost = 0.0;                                                 ///< what was minimised, at X_WC.
  double rms_px = 0.0;                                               ///< of the distances, weights counted.
  int steps = 0;
};

/// F_i(X) and its derivative by a step of geometry::moved() (Eq. 4.1, 4.3).
/// \return false: the point is not in front of the camera.
bool distance_of(const LineDistance& line, const geometry::Pose& X_WC, const geometry::Camera& camera, double& distance,
                 Eigen::Matrix<double, 1, 6>& jacobian);

/// Minimises the distances over the six numbers of the pose (Eq. 4.5) from `start`.
///
/// Ours: the sum of robust squared distances in sigmas, plus the prior's. lambda = 1 with units of one sigma in each dimension is exactly that
/// prior. Damped further only where a step makes it worse. \param prior_information  inverse of the prior's covariance.
Solution solve(std::span<const LineDistance> lines, const geometry::Pose& start, const Prior& prior,
               const geometry::Matrix6d& prior_information, const geometry::Camera& camera,
               const SolverOptions& options);

/// The sum that solve() minimises, and the number of distances that are in front of the camera.
struct Cost {
  double sum = 0.0;
  int count = 0;
};
Cost cost_of(std::span<const LineDistance> lines, const geometry::Pose& X_WC, const Prior& prior,
             const geometry::Matrix6d& prior_information, const geometry::Camera& camera, double robust);

}  // namespace cgsr::localization
