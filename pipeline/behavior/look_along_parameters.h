#pragma once

#include "platform/parameters.h"

namespace cgsr::behavior {

/// How a robot looks along a line of people (6.4.1.2). Ours: the dissertation does not say how the robot turned.
struct LookAlongParameters {
  double reach_deg = 45.0;
  double turn_degps = 15.0;
  int images_to_name = 40;
  double patience_s = 5.0;
  double same_bearing_deg = 7.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("reach_deg", self.reach_deg, {0.0, 170.0}, "deg",
                 "How far the robot turns to the left and then to the right of its first direction.");
    visit.number("turn_degps", self.turn_degps, {1.0, 90.0}, "deg/s", "How fast it turns where nobody is to be named.");
    visit.number("images_to_name", self.images_to_name, {1, 1000}, "",
                 "The robot stands before a face until its name is known in so many images.");
    visit.number("patience_s", self.patience_s, {0.1, 60.0}, "s",
                 "After so long before somebody it goes on, with what it knows of him.");
    visit.number("same_bearing_deg", self.same_bearing_deg, {0.5, 45.0}, "deg",
                 "Faces whose bearings differ by less are one person's.");
  }
};

}  // namespace cgsr::behavior
