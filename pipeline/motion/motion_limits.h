#pragma once

#include <string>

#include "hal/drive.h"
#include "pipeline/behavior/drive_limits.h"
#include "platform/parameters.h"

namespace cgsr {

/// The rectangle of the odometry frame (origin: where the robot was started, x: where it looked then) that the robot
/// may not leave.
struct KeepInParameters {
  bool enabled = true;
  double min_x_m = -5.0;
  double max_x_m = 5.0;
  double min_y_m = -5.0;
  double max_y_m = 5.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.flag("enabled", self.enabled, "The robot is kept inside the area; the odometry that this relies on drifts.");
    visit.number("min_x_m", self.min_x_m, {-1000.0, 1000.0}, "m",
                 "The rear edge of the area, seen from the start pose.");
    visit.number("max_x_m", self.max_x_m, {-1000.0, 1000.0}, "m", "The front edge of the area.");
    visit.number("min_y_m", self.min_y_m, {-1000.0, 1000.0}, "m", "The right edge of the area.");
    visit.number("max_y_m", self.max_y_m, {-1000.0, 1000.0}, "m", "The left edge of the area.");
  }

  /// \return what is wrong with the keys together; empty when nothing is.
  [[nodiscard]] std::string inconsistency() const {
    return min_x_m < max_x_m && min_y_m < max_y_m
               ? ""
               : "the area is empty: min_x_m must be below max_x_m, and min_y_m below max_y_m";
  }
};

/// How fast the wheels may be told to go, and when they are told to stop.
/// Ours: the dissertation (3.3.2) gives no limits of its Segway RMP.
struct MotionParameters : behavior::DriveLimits {
  double reaction_s = 0.2;
  double goal_timeout_s = 0.150;
  double feedback_timeout_s = 0.100;
  double max_hold_s = 2.0;
  bool armed_at_start = false;
  KeepInParameters keep_in;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    DriveLimits::describe(self, visit);
    visit.number("reaction_s", self.reaction_s, {0.0, 1.0}, "s",
                 "The time from a command until the base obeys it, which the keep-in area accounts for.");
    visit.number("goal_timeout_s", self.goal_timeout_s, {0.02, 0.5}, "s",
                 "Zero is commanded when the newest goal is older than this, counted from the stamp of its image.");
    visit.number("feedback_timeout_s", self.feedback_timeout_s, {0.02, 0.5}, "s",
                 "Zero is commanded and the robot disarms when the newest odometry is older than this.");
    visit.number("max_hold_s", self.max_hold_s, {0.1, 60.0}, "s",
                 "The robot disarms when a passing cause has held it for this time; it must then be armed again.");
    visit.flag("armed_at_start", self.armed_at_start,
               "The robot arms itself once, as soon as arming is possible; for simulation only.");
    visit.section("keep_in", self.keep_in, "The area that the robot may not leave, in the frame of its odometry");
  }
};

/// \return `goal` within the speed and turn limits.
hal::Twist clamp(const hal::Twist& goal, const MotionParameters& limits);

/// The fastest speed v of `forward_mps`' sign, at most itself, from which the robot still stops inside the area:
///
///     v t + v^2 / (2 a) <= D    and    u t + v^2 / (2 a) <= D
///
/// t: age_s + reaction_s, in which the robot goes on at the speed u that it has; a: the deceleration limit; D: the way to
/// the nearest edge over all headings that it can reach until it stands, at the turn limit and to either side. Outside the
/// area only motion that leads back in is left.
/// \param odometry  finite.
/// \param age_s  of the odometry, >= 0.
double speed_within_area(double forward_mps, const hal::Odometry& odometry, double age_s,
                         const MotionParameters& limits);

}  // namespace cgsr
