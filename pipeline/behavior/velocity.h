#pragma once

namespace cgsr::behavior {

/// How a behaviour wants the robot to move, in the robot's own frame (x forward, y left, z up). What a base is told in
/// the end is the motion loop's to say.
/// Ours: the dissertation (3.3.2) does not describe the commands to its Segway RMP.
struct Velocity {
  double forward_mps = 0.0;
  double left_radps = 0.0;  ///< about z, positive turns left.
};

}  // namespace cgsr::behavior
