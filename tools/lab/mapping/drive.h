#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "hal/sim/generator/home.h"
#include "pipeline/geometry/camera.h"
#include "pipeline/mapping/view.h"
#include "tools/lab/localization/place.h"

namespace cgsr::lab {

/// How far given poses are off, as those of a robot are that localizes against a map of this kind: together for a while, N(0, ..) at any time.
struct PoseErrors {
  double place_m = 0.05;
  double height_m = 0.005;
  double heading_rad = 0.0175;
  double tilt_rad = 0.005;
  double images = 20.0;          ///< that an error lasts.
  double odometry_share = 0.02;  ///< of the way.
  double odometry_turn_share = 0.03;

  [[nodiscard]] PoseErrors times(double factor) const;
};

/// A drive through a home: what the robot perceives, and from where it really does.
struct Drive {
  std::vector<mapping::View> views;
  std::vector<geometry::Pose> true_poses;  ///< X_WC.
  geometry::Camera camera;                 ///< in which the views' edges are.
};

/// Drives the home's own round once and looks along it and to either side, ray traced. \param images  about so many.
/// \param told  the camera as the robot has it.
Drive drive_through(const sim::GeneratedHome& home, Place& place, const geometry::Camera& told,
                    const PoseErrors& errors, int images, std::uint32_t seed, const std::function<void(int)>& progress);

}  // namespace cgsr::lab
