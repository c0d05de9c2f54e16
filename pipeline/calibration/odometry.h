#pragma once

#include <vector>

#include "pipeline/geometry/pose.h"
#include "platform/error.h"

namespace cgsr::calibration {

/// By what the odometry's way and turn are to be multiplied.
struct OdometryFit {
  double forward = 1.0;
  double turn = 1.0;
  double sigma_forward = 0.0;
  double sigma_turn = 0.0;
  double rms_m = 0.0;         ///< what is left per stretch, place.
  double rms_rad = 0.0;       ///< and heading.
  double rms_before_m = 0.0;  ///< with scales of 1.
  double rms_before_rad = 0.0;
  double way_m = 0.0;       ///< driven, by the odometry.
  double turned_rad = 0.0;  ///< turned in all, both ways.
  int stretches = 0;
};

/// The odometry's increments times scales, from the odometry's first pose on.
std::vector<geometry::Pose> scaled_odometry(const std::vector<geometry::Pose>& X_OR, double forward, double turn);

/// Least squares over stretches of about `stretch_m` of way (or 60 degrees of turn): each stretch of the scaled odometry is laid on the true
/// one's first pose and compared at its end, so that errors of the start and slip of other stretches stay out. Ours.
/// \return or why not: fewer than 3 stretches, hardly any way or turn; true poses that lean as a camera's do; the scaled odometry lies too far
///         off; a scale that no robot's file takes, or that is known too badly.
Result<OdometryFit> calibrate_odometry(const std::vector<geometry::Pose>& X_OR, const std::vector<geometry::Pose>& X_WR,
                                       double stretch_m = 2.0);

}  // namespace cgsr::calibration
