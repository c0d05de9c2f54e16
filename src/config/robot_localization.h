#pragma once

#include <array>
#include <string>
#include <string_view>

#include "pipeline/behavior/finals_parameters.h"
#include "pipeline/behavior/follow_person_parameters.h"
#include "pipeline/behavior/look_along_parameters.h"
#include "pipeline/behavior/route.h"
#include "pipeline/behavior/search_people_parameters.h"
#include "pipeline/behavior/seek_lamp.h"
#include "pipeline/calibration/marker.h"
#include "pipeline/localization/localizer_parameters.h"
#include "pipeline/localization/pose_tracker.h"
#include "platform/parameters.h"
#include "src/config/prior.h"

namespace cgsr::config {

/// Where the robot stands at boot, and how well that is known.
struct StartPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_deg = 0.0;
  double sigma_m = 0.15;
  double sigma_deg = 4.0;
  std::string file;
  calibration::Marker marker;
  bool anywhere = false;
  double turn_radps = 0.6;
  double again_after_s = 10.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("x_m", self.x_m, {-10000.0, 10000.0}, "m", "The x coordinate of the robot in the world.");
    visit.number("y_m", self.y_m, {-10000.0, 10000.0}, "m", "The y coordinate of the robot in the world.");
    visit.number("heading_deg", self.heading_deg, {-360.0, 360.0}, "deg",
                 "The heading from the world's x axis, positive to the left.");
    visit.number("sigma_m", self.sigma_m, {0.001, 10.0}, "m", "The standard deviation of each coordinate.");
    visit.number("sigma_deg", self.sigma_deg, {0.01, 90.0}, "deg", "The standard deviation of the heading.");
    visit.path("file", self.file,
               "The file in which a run that knows its pose at its end stores it; empty means none. The next run "
               "prefers it to the pose above and takes the file away when it begins; at its end it stores its own "
               "pose, or puts the old one back where it knows none and the base was never armed. A dry run does not "
               "take it away, nor does a run without a map.");
    visit.section("marker", self.marker,
                  "A marker at a known place that is searched for in the first image when there is no such file");
    visit.flag(
        "anywhere", self.anywhere,
        "When neither such a file nor the marker says where the robot is, it turns on the spot and searches the "
        "whole map for its pose, instead of beginning at the pose above; its task waits until the pose is found.");
    visit.number("turn_radps", self.turn_radps, {0.1, 0.78}, "rad/s", "The turn rate during this search.");
    visit.number(
        "again_after_s", self.again_after_s, {0.0, 3600.0}, "s",
        "With anywhere: when the pose stays lost for so long, the robot searches the whole map again. Only the time of "
        "images that could have corrected the pose counts; 0 means never.");
  }
};

/// The section [localization] of a robot's file: chapter 4. Without a map the robot does not ask where it is.
struct RobotLocalization {
  std::string map;
  std::string camera;
  std::string mount;
  double axle_height_m = 0.24;
  StartPose start;
  PriorParameters prior;
  localization::LocalizerParameters localizer;
  localization::PoseTrackerParameters tracker;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.path("map", self.map,
               "The geometry of the home (.obj, .gltf, .cao or the output of cgsr map import); empty means no map.");
    visit.path("camera", self.camera,
               "The intrinsics with the lens distortion, in the format of ROS's camera_calibration.");
    visit.path("mount", self.mount,
               "The file with the pose of the camera on the robot: its section [mount], as written by cgsr calibrate "
               "mount or cgsr sim export.");
    visit.number("axle_height_m", self.axle_height_m, {0.0, 2.0}, "m",
                 "The height of the axle about which the base leans.");
    visit.section("start", self.start, "The robot's pose at boot");
    visit.section("prior", self.prior,
                  "The uncertainty of a pose given to cgsr localize; a robot begins with that of localization.start");
    visit.section("localizer", self.localizer, "Correction of a pose with one image (Alg. 4.1, 4.2)");
    visit.section("tracker", self.tracker, "Propagation of the pose from image to image");
  }
};

enum class TaskKind : std::uint8_t {
  kFollow,        ///< keep at a distance from an object.
  kRoute,         ///< drive from place to place.
  kLamp,          ///< Algorithm 5.2: find the lamp, back off, track with masks.
  kPerson,        ///< keep at a distance from a person who is enrolled (6.4).
  kLine,          ///< tell who is who in a line of people (6.4.1.2).
  kSearchPeople,  ///< find people all over the home and tell where who is (6.4.1.2).
  kFinals,        ///< follow a person, tell a stranger in the same shirt and a change of shirts (6.4.3).
};
inline constexpr std::array kTaskKindNames{Named<TaskKind>{"follow", TaskKind::kFollow},
                                           Named<TaskKind>{"route", TaskKind::kRoute},
                                           Named<TaskKind>{"lamp", TaskKind::kLamp},
                                           Named<TaskKind>{"person", TaskKind::kPerson},
                                           Named<TaskKind>{"line", TaskKind::kLine},
                                           Named<TaskKind>{"finals", TaskKind::kFinals},
                                           Named<TaskKind>{"search_people", TaskKind::kSearchPeople}};
constexpr std::string_view to_string(TaskKind kind) {
  return word_in(kTaskKindNames, kind);
}

struct Task {
  TaskKind kind = TaskKind::kFollow;
  behavior::RouteParameters route;
  behavior::SeekLampParameters lamp;
  behavior::FollowPersonParameters person;
  behavior::LookAlongParameters line;
  behavior::FinalsParameters finals;
  behavior::SearchPeopleParameters search_people;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice(
        "kind", self.kind, kTaskKindNames,
        "The task follow keeps at a distance from an object; route drives from place to place; lamp runs "
        "Algorithm 5.2; these two need a map. The task person keeps at a distance from somebody who is enrolled; "
        "line tells who is who in a line of people; search_people looks for people all over the map and tells where "
        "who is; finals follows as person does, and tells strangers and changes of "
        "shirts.");
    visit.section("route", self.route, "The places and the speed of a route");
    visit.section("lamp", self.lamp, "Exploring, locating the lamp, backing off and tracking (Alg. 5.2)");
    visit.section("person", self.person, "Whom the robot follows (6.4)");
    visit.section("line", self.line, "Looking along a line of people (6.4.1.2)");
    visit.section("finals", self.finals, "Telling strangers and changes of shirts (6.4.3)");
    visit.section("search_people", self.search_people, "Looking for people all over the home (6.4.1.2)");
  }
};

}  // namespace cgsr::config
