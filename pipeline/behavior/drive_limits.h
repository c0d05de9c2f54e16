#pragma once

#include "platform/parameters.h"

namespace cgsr::behavior {

/// How fast the robot may drive and turn, and how fast that may change: the one set of limits, section [motion] of a robot's file. Behaviours
/// plan within it, and the motion loop holds it whatever they plan. The robot is blind backwards and has no obstacle sensor: the defaults are
/// slow and never backwards.
/// Ours: the dissertation (3.3.2) gives no limits of its Segway RMP.
struct DriveLimits {
  double max_forward_mps = 0.3;
  double max_backward_mps = 0.0;
  double max_acceleration_mps2 = 0.3;
  double max_deceleration_mps2 = 0.6;
  double max_turn_radps = 0.8;
  double max_turn_acceleration_radps2 = 1.5;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("max_forward_mps", self.max_forward_mps, {0.0, 1.5}, "m/s", "The largest forward speed.");
    visit.number("max_backward_mps", self.max_backward_mps, {0.0, 0.5}, "m/s",
                 "The largest backward speed; the robot has no sensor that looks backwards.");
    visit.number("max_acceleration_mps2", self.max_acceleration_mps2, {0.05, 3.0}, "m/s²",
                 "The largest rate at which the speed increases.");
    visit.number("max_deceleration_mps2", self.max_deceleration_mps2, {0.05, 3.0}, "m/s²",
                 "The largest rate at which the speed decreases towards a slower goal; a stop does not wait for it.");
    visit.number("max_turn_radps", self.max_turn_radps, {0.0, 2.0}, "rad/s", "The largest turn rate.");
    visit.number("max_turn_acceleration_radps2", self.max_turn_acceleration_radps2, {0.1, 10.0}, "rad/s²",
                 "The largest rate at which the turn rate changes.");
  }
};

}  // namespace cgsr::behavior
