#pragma once

#include "pipeline/behavior/free_floor.h"
#include "platform/parameters.h"

namespace cgsr::behavior {

/// Whom a robot follows (6.4). Ours; the distance and the reaction to a loss are those of FollowParameters.
struct FollowPersonParameters {
  int number = 0;
  double face_width_m = 0.16;
  FreeFloorParameters floor{};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number(
        "number", self.number, {0, 1000000}, "",
        "The number of the person in the identities file; with 0 the robot follows the first who is identified.");
    visit.number("face_width_m", self.face_width_m, {0.05, 0.5}, "m",
                 "The width of what the face detector takes for a face: the distance follows from it.");
    visit.section("floor", self.floor, "The map's free floor, which the robot that follows somebody does not leave");
  }
};

}  // namespace cgsr::behavior
