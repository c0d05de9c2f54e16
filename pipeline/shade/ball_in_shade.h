#pragma once

#include <Eigen/Core>

#include "pipeline/shade/lamp_view.h"

namespace cgsr::shade {

/// A ball whose place is known to some degree, in W.
struct UncertainBall {
  Eigen::Vector3f p_WB = Eigen::Vector3f::Zero();  ///< its middle.
  Eigen::Vector3f along =
      Eigen::Vector3f::UnitX();  ///< unit vector in which the middle may be off furthest: the camera's ray.
  float radius_m = 0.0F;
  float along_m = 0.0F;   ///< the most that it is off by, either way, in that direction,
  float across_m = 0.0F;  ///< and in every other; what lamp and map may move the shade's border by included.
};

/// Whether the map may hide the lamp's centre from some of a ball, by rays to an outline around every place in which it may be. What stands closer to
/// the ball than its place may be off by is taken to throw no shade on it: else what it lies on would. Of something thin a shadow may fall
/// between the rays. Ours.
bool may_lie_in_shade(const UncertainBall& ball, const LampView& lamp, const Eigen::Vector3f& p_WL);

/// Whether the map hides the lamp's centre from all of a ball, by the same rays: wherever it may be.
bool lies_in_shade(const UncertainBall& ball, const LampView& lamp, const Eigen::Vector3f& p_WL);

}  // namespace cgsr::shade
