#pragma once

#include "pipeline/behavior/follow.h"
#include "pipeline/motion_limits.h"

namespace cgsr::config {

/// Everything a robot's file says (config/robots/*.toml). Each section's struct lives with the code that it steers.
struct Robot {
  MotionParameters motion;
  behavior::FollowParameters follow;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("motion", self.motion, "How fast the wheels may be told to go, and when they are told to stop");
    visit.section("follow", self.follow, "Following an object: how close, how fast, and what to do when it is gone");
  }
};

}  // namespace cgsr::config
