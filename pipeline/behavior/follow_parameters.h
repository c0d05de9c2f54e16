#pragma once

#include "platform/parameters.h"

namespace cgsr::behavior {

/// How close, how fast, and what to do when the object is gone: parameters of Follow (3.3.2).
struct FollowParameters {
  double distance_m = 1.5;
  double learned_distance_m = 0.0;
  double distance_band_m = 0.15;
  double approach_per_s = 0.5;
  double bearing_band_rad = 0.03;
  double turn_per_s = 1.2;
  double max_driving_bearing_rad = 0.5;
  double max_box_age_s = 0.3;
  double search_after_s = 1.0;
  double max_search_s = 20.0;
  double search_turn_radps = 0.4;
  double confirm_s = 0.5;
  double min_motion_radps = 0.1;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("distance_m", self.distance_m, {0.3, 5.0}, "m", "The distance that the robot keeps from the object.");
    visit.number("learned_distance_m", self.learned_distance_m, {0.0, 10.0}, "m",
                 "The distance at which the object's size was learned; 0 means unknown, and the first detected box "
                 "then counts as distance_m.");
    visit.number("distance_band_m", self.distance_band_m, {0.0, 1.0}, "m",
                 "A distance error within this band is treated as zero.");
    visit.number("approach_per_s", self.approach_per_s, {0.0, 3.0}, "1/s",
                 "The forward speed per metre of distance error.");
    visit.number("bearing_band_rad", self.bearing_band_rad, {0.0, 0.5}, "rad",
                 "A bearing within this band is treated as zero.");
    visit.number("turn_per_s", self.turn_per_s, {0.0, 5.0}, "1/s", "The turn rate per radian of bearing.");
    visit.number("max_driving_bearing_rad", self.max_driving_bearing_rad, {0.05, 3.2}, "rad",
                 "From this bearing on the robot only turns; at smaller bearings the speed grows linearly to its full "
                 "value at zero.");
    visit.number("max_box_age_s", self.max_box_age_s, {0.05, 2.0}, "s",
                 "A box from an image older than this counts as not found.");
    visit.number("search_after_s", self.search_after_s, {0.0, 10.0}, "s",
                 "The time that the robot stands still after a loss before it starts to search.");
    visit.number("max_search_s", self.max_search_s, {0.0, 120.0}, "s",
                 "The time that the robot searches before it gives the object up.");
    visit.number("search_turn_radps", self.search_turn_radps, {0.0, 1.0}, "rad/s", "The turn rate while searching.");
    visit.number(
        "confirm_s", self.confirm_s, {0.0, 5.0}, "s",
        "A box decides the side of a search only when the object was followed for this long after it; what was "
        "followed in the last moments before a loss may have been a look-alike.");
    visit.number("min_motion_radps", self.min_motion_radps, {0.0, 5.0}, "rad/s",
                 "The search turns towards the object's direction of motion where that was at least this fast; "
                 "otherwise towards the side on which the object was.");
  }
};

}  // namespace cgsr::behavior
