#pragma once

#include <string>

#include "pipeline/behavior/free_floor.h"
#include "platform/parameters.h"

namespace cgsr::behavior {

/// How a robot looks for people all over a home (6.4.1.2, spread through the home). Ours: the dissertation does not say how the robot searched.
struct SearchPeopleParameters {
  double max_duration_s = 300.0;
  double forward_mps = 0.4;
  double turn_degps = 20.0;
  double reached_m = 0.25;
  int images_to_name = 30;
  double patience_s = 4.0;
  double same_place_m = 1.0;
  double face_width_m = 0.17;
  double min_face_px = 42.0;
  double min_face_height_m = 1.2;
  double max_face_height_m = 2.0;
  double min_distance_m = 0.7;
  double max_unseen_share = 0.01;
  FreeFloorParameters floor{};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("max_duration_s", self.max_duration_s, {1.0, 3600.0}, "s",
                 "After so long the robot ends its search and tells whom it has found.");
    visit.number("forward_mps", self.forward_mps, {0.01, 1.5}, "m/s", "The speed on the way between lookouts.");
    visit.number(
        "turn_degps", self.turn_degps, {1.0, 90.0}, "deg/s",
        "How fast it turns round at a lookout; a face has to stay in view for a search through the whole image.");
    visit.number("reached_m", self.reached_m, {0.05, 1.0}, "m", "A lookout counts as reached within this distance.");
    visit.number("images_to_name", self.images_to_name, {1, 1000}, "",
                 "The robot stands before a face until its name is known in so many images.");
    visit.number("patience_s", self.patience_s, {0.1, 60.0}, "s",
                 "After so long before somebody it goes on to the next lookout and tries again from there.");
    visit.number("same_place_m", self.same_place_m, {0.1, 5.0}, "m",
                 "Faces whose places in the map are nearer to each other are one person's.");
    visit.number("face_width_m", self.face_width_m, {0.05, 0.5}, "m",
                 "The width of what the face detector takes for a face: the distance follows from it.");
    visit.number("min_face_px", self.min_face_px, {10.0, 400.0}, "px",
                 "The width at which a usual face is named: the greatest distance of a lookout from what is seen there "
                 "follows from it. The face of a small head counts from 0.85 of it on.");
    visit.number("min_face_height_m", self.min_face_height_m, {0.0, 3.0}, "m",
                 "What looks like a face lower above the floor is none.");
    visit.number("max_face_height_m", self.max_face_height_m, {0.0, 3.0}, "m",
                 "What looks like a face higher above the floor is none.");
    visit.number("min_distance_m", self.min_distance_m, {0.0, 3.0}, "m",
                 "A face that is nearer to a lookout may lie above the image.");
    visit.number("max_unseen_share", self.max_unseen_share, {0.0, 0.5}, "",
                 "The share of the floor on which people may stand that the lookouts together may leave unseen.");
    visit.section("floor", self.floor, "The part of the map's floor where the robot may drive");
  }

  /// \return what is wrong with the keys together; empty when nothing is.
  [[nodiscard]] std::string inconsistency() const {
    return min_face_height_m >= max_face_height_m ? "min_face_height_m is not below max_face_height_m" : "";
  }
};

}  // namespace cgsr::behavior
