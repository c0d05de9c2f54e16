#pragma once

#include <array>
#include <string>

#include "pipeline/behavior/route.h"
#include "pipeline/behavior/seek_lamp.h"
#include "pipeline/localization/localizer_parameters.h"
#include "pipeline/localization/pose_tracker.h"
#include "platform/parameters.h"

namespace cgsr::config {

/// An ArUco marker on a wall whose place is known.
struct StartMarker {
  int id = -1;
  double side_m = 0.15;
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 1.0;
  double facing_deg = 0.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("id", self.id, {-1, 49}, "", "its number among the 4x4 markers (OpenCV's DICT_4X4_50); -1: none");
    visit.number("side_m", self.side_m, {0.01, 2.0}, "m", "side of its black square");
    visit.number("x_m", self.x_m, {-10000.0, 10000.0}, "m", "of its middle, in the world");
    visit.number("y_m", self.y_m, {-10000.0, 10000.0}, "m", "of its middle");
    visit.number("z_m", self.z_m, {-100.0, 100.0}, "m", "of its middle, above the floor");
    visit.number("facing_deg", self.facing_deg, {-360.0, 360.0}, "deg", "whither it looks, from the world's x axis");
  }
};

/// Where the robot stands at boot, and how well that is known.
struct StartPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_deg = 0.0;
  double sigma_m = 0.15;
  double sigma_deg = 4.0;
  std::string file;
  StartMarker marker;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("x_m", self.x_m, {-10000.0, 10000.0}, "m", "in the world");
    visit.number("y_m", self.y_m, {-10000.0, 10000.0}, "m", "in the world");
    visit.number("heading_deg", self.heading_deg, {-360.0, 360.0}, "deg", "from the world's x axis, to the left");
    visit.number("sigma_m", self.sigma_m, {0.001, 10.0}, "m", "standard deviation of each coordinate");
    visit.number("sigma_deg", self.sigma_deg, {0.01, 90.0}, "deg", "standard deviation of the heading");
    visit.text("file", self.file,
               "where a run leaves its pose for the next one, which prefers it to the above; empty: nowhere");
    visit.section("marker", self.marker,
                  "A marker of known place, looked for in the first image when there is no such file");
  }
};

/// The section [localization] of a robot's file: chapter 4. Without a map the robot does not ask where it is.
struct RobotLocalization {
  std::string map;
  std::string camera;
  std::string mount;
  double axle_height_m = 0.24;
  StartPose start;
  localization::LocalizerParameters localizer;
  localization::PoseTrackerParameters tracker;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("map", self.map,
               "geometry of the home (.obj, .gltf, .cao or what cgsr map import wrote); empty: no map");
    visit.text("camera", self.camera, "intrinsics with the lens, as ROS's camera_calibration writes them");
    visit.text("mount", self.mount, "where the camera is on the robot: [mount] of what cgsr sim export writes");
    visit.number("axle_height_m", self.axle_height_m, {0.0, 2.0}, "m", "of the axle about which the base leans");
    visit.section("start", self.start, "Where the robot stands when it boots");
    visit.section("localizer", self.localizer, "Correcting a pose by an image (Alg. 4.1, 4.2)");
    visit.section("tracker", self.tracker, "The pose from image to image");
  }
};

enum class TaskKind : std::uint8_t {
  kFollow,  ///< keep at a distance from an object.
  kRoute,   ///< drive from place to place.
  kLamp,    ///< Algorithm 5.2: find the lamp, back off, track with masks.
};
inline constexpr std::array kTaskKindNames{Named<TaskKind>{"follow", TaskKind::kFollow},
                                           Named<TaskKind>{"route", TaskKind::kRoute},
                                           Named<TaskKind>{"lamp", TaskKind::kLamp}};

struct Task {
  TaskKind kind = TaskKind::kFollow;
  behavior::RouteParameters route;
  behavior::SeekLampParameters lamp;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("kind", self.kind, kTaskKindNames,
                 "follow: an object; route: from place to place; lamp: Algorithm 5.2; the last two need a map");
    visit.section("route", self.route, "The places, and how fast");
    visit.section("lamp", self.lamp, "Explore, locate the lamp, back off, track (Alg. 5.2)");
  }
};

}  // namespace cgsr::config
