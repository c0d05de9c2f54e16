#pragma once

#include <array>
#include <string_view>

#include "pipeline/behavior/velocity.h"
#include "pipeline/stages/events.h"
#include "pipeline/stages/requests.h"
#include "platform/description.h"

namespace cgsr::stages {

/// What a task (following, 3.3.2; Alg. 5.2) did about one image.
struct Decision {
  behavior::Velocity goal;  ///< of the robot, [m/s] and [rad/s].
  bool halt = false;        ///< forward motion ends at once, without a ramp.
  std::string_view state;   ///< of the task, for people; text that lives as long as the program.
  std::string_view reason;  ///< of the last change of state.
  Requests requests;        ///< to stages and devices, for the next image.
  Events events{};          ///< of this image: the stage adds the change of state, the task what it has to say beside.

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("state", self.state, "state of the task");
    visit.number("goal_mps", self.goal.forward_mps, {4}, "m/s", "forward speed that the task wants");
    visit.number("goal_radps", self.goal.left_radps, {4}, "rad/s",
                 "turn rate that the task wants, positive to the left");
  }
};

}  // namespace cgsr::stages
