#pragma once

#include <array>
#include <string>
#include <string_view>

#include "hal/simulation.h"
#include "pipeline/behavior/follow.h"
#include "pipeline/color/ball/integrated_tracker.h"
#include "pipeline/illumination/lamp.h"
#include "pipeline/motion/motion_limits.h"
#include "pipeline/stages/odometry_track.h"
#include "pipeline/vision_loop.h"
#include "platform/config/provenance.h"
#include "src/config/color.h"
#include "src/config/devices.h"
#include "src/config/light.h"
#include "src/config/person.h"
#include "src/config/robot_localization.h"

namespace cgsr::config {

enum class Pace : std::uint8_t {
  kLockStep,  ///< one thread steps everything, the stamps are the time: as fast as it goes, the same bytes every time.
  kRealTime,  ///< the same, but no faster than the clock: time slows where images take longer, and none is dropped.
  kLive,      ///< every task has its thread and the clock is real.
};
inline constexpr std::array kPaceNames{Named<Pace>{"lock_step", Pace::kLockStep},
                                       Named<Pace>{"real_time", Pace::kRealTime}, Named<Pace>{"live", Pace::kLive}};
constexpr std::string_view to_string(Pace pace) {
  return word_in(kPaceNames, pace);
}

/// Where in the first image the object is that shall be followed. No width: it is not learned so.
struct LearnRegion {
  int x_px = 0;
  int y_px = 0;
  int width_px = 0;
  int height_px = 0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("x_px", self.x_px, {0, 8192}, "px", "The left edge of the region.");
    visit.number("y_px", self.y_px, {0, 8192}, "px", "The upper edge of the region.");
    visit.number("width_px", self.width_px, {0, 8192}, "px", "The width of the region; with 0 nothing is learned.");
    visit.number("height_px", self.height_px, {0, 8192}, "px", "The height of the region; with 0 nothing is learned.");
  }

  [[nodiscard]] bool empty() const { return width_px == 0 || height_px == 0; }
};

struct Run {
  Pace pace = Pace::kLockStep;
  double result_latency_s = 0.033;
  std::string model;
  LearnRegion learn;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("pace", self.pace, kPaceNames,
                 "With lock_step the stamps are the time; real_time is the same, but no faster than the clock; live "
                 "runs a thread per task.");
    visit.number(
        "result_latency_s", self.result_latency_s, {0.0, 0.5}, "s",
        "The time from an image's stamp until its result reaches motion in lock-step, however slow the machine is.");
    visit.path("model", self.model, "The object to follow: a model file written by cgsr learn.");
    visit.section("learn", self.learn,
                  "The region of the first image that is learned and followed when no model is given");
  }
};

/// Everything a robot's file says (config/robots/*.toml). Each section's struct lives with the code that it steers.
struct Robot {
  Run run;
  Camera camera;
  Base base;
  Switches switches;
  hal::SimulationParameters sim;
  VisionStages stage;
  Color color;
  RobotLocalization localization;
  stages::OdometryScales odometry;
  Mount mount;
  color::IntegratedParameters integrated;
  illumination::ProbesParameters probes;
  illumination::LampParameters lamp;
  stages::ShadeStageParameters shade;
  Person person;
  Task task;
  behavior::FollowParameters follow;
  MotionParameters motion;
  Provenance provenance;  ///< where the values came from; not a value itself.

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("run", self.run, "How the program runs");
    visit.section("camera", self.camera, "The source of the images");
    visit.section("base", self.base, "The base that carries the camera");
    visit.section("switches", self.switches, "Named input and output lines");
    visit.section("sim", self.sim, "The simulated home, where the kind of camera, CAN bus or switches is \"sim\"");
    visit.section("stage", self.stage, "The schedule: the frames in which each stage runs and what it may cost");
    visit.section("color", self.color, "Colour tracking (chapter 3)");
    visit.section("localization", self.localization, "Localization (chapter 4)");
    visit.section("odometry", self.odometry,
                  "The scales of the base's odometry, applied before it propagates the pose");
    visit.section("mount", self.mount,
                  "The pose of the camera on the robot, for cgsr light and cgsr calibrate probes where "
                  "localization.mount names no file");
    visit.section(
        "integrated", self.integrated,
        "The ball tracker with separate searches in bright and possibly shaded regions (5.3; task.kind = \"lamp\")");
    visit.section("probes", self.probes, "The probe board and how it is observed (Alg. 5.1)");
    visit.section("lamp", self.lamp, "Prior knowledge of lamps, and the fusion of observations (Eq. 5.1, 5.2)");
    visit.section("shade", self.shade, "The shadow masks of the lamp (5.2)");
    visit.section("person", self.person, "Who is in view (chapter 6)");
    visit.section("task", self.task, "The task of the robot");
    visit.section("follow", self.follow, "Following an object: distance, speed and the reaction to a loss");
    visit.section("motion", self.motion, "The limits of wheel commands and the conditions for a stop");
  }

  /// The task is about an object, or one is named all the same.
  [[nodiscard]] bool needs_object() const {
    if (task.kind == TaskKind::kRoute) return false;
    return !about_people() || !run.model.empty() || !run.learn.empty();
  }

  /// The task is about people who are enrolled.
  [[nodiscard]] bool about_people() const { return follows_person() || names_people(); }

  /// The task is to tell who is who.
  [[nodiscard]] bool names_people() const {
    return task.kind == TaskKind::kLine || task.kind == TaskKind::kSearchPeople;
  }

  /// The task is to follow somebody.
  [[nodiscard]] bool follows_person() const { return task.kind == TaskKind::kPerson || task.kind == TaskKind::kFinals; }

  [[nodiscard]] bool simulated_camera() const { return camera.kind == CameraKind::kSim; }
  [[nodiscard]] bool simulated_base() const { return base.kind == BaseKind::kRmp && base.can == CanKind::kSim; }
  [[nodiscard]] bool simulated_switches() const { return switches.kind == SwitchesKind::kSim; }
  /// Some device is part of the simulated home.
  [[nodiscard]] bool simulated() const { return simulated_camera() || simulated_base() || simulated_switches(); }

  [[nodiscard]] bool real_camera() const { return camera.kind == CameraKind::kV4l2; }
  [[nodiscard]] bool real_base() const { return base.kind == BaseKind::kRmp && base.can == CanKind::kSocketCan; }
  [[nodiscard]] bool real_switches() const { return switches.kind == SwitchesKind::kGpiod; }
  /// Some device is one of this computer.
  [[nodiscard]] bool real() const { return real_camera() || real_base() || real_switches(); }

  /// \return what is wrong with what is said of the map; empty when nothing is.
  [[nodiscard]] std::string map_inconsistency() const {
    if (!localization.map.empty() && (localization.camera.empty() || localization.mount.empty())) {
      return "localization.map needs localization.camera and localization.mount beside it";
    }
    if (localization.start.anywhere && localization.map.empty()) {
      return "localization.start.anywhere needs a map (localization.map): that is what is searched for the pose";
    }
    if (localization.start.anywhere && task.kind == TaskKind::kSearchPeople) {
      return "localization.start.anywhere does not go with task.kind = \"search_people\", whose places are planned "
             "before the first image from where the robot starts";
    }
    return "";
  }

  /// \return what is wrong with the sections together; empty when nothing is.
  [[nodiscard]] std::string inconsistency() const {
    const bool live = run.pace == Pace::kLive;
    if (about_people() && !person.enabled()) {
      return "task.kind = \"person\", \"line\", \"search_people\" and \"finals\" need person.identities: the file in "
             "which cgsr people enroll keeps who is known; \"person\" can do with person.marker.enabled instead";
    }
    if ((names_people() || task.kind == TaskKind::kFinals) && !person.knows_faces()) {
      return "task.kind = \"line\", \"search_people\" and \"finals\" need person.identities: they tell people by their "
             "faces, not by a marker";
    }
    if (task.kind == TaskKind::kFinals && task.person.number == 0) {
      return "task.kind = \"finals\" needs task.person.number, the number of the person in the identities file: who is "
             "to be followed, and who is a stranger?";
    }
    if (person.fill_light.enabled && (switches.fill_light_line.empty() || !follows_person())) {
      return "person.fill_light needs switches.fill_light_line, the line of the light, and task.kind = \"person\" "
             "or \"finals\", which alone ask for it";
    }
    if ((task.kind == TaskKind::kRoute || task.kind == TaskKind::kLamp || task.kind == TaskKind::kSearchPeople) &&
        localization.map.empty()) {
      return "task.kind = \"route\", \"lamp\" and \"search_people\" need a map (localization.map): places mean nothing "
             "to a robot without one";
    }
    if (probes.board.probes > 0 && (localization.camera.empty() || localization.mount.empty())) {
      return "probes.board needs localization.camera and localization.mount: shadows are measured through them";
    }
    if (shade.lamp.given && (localization.map.empty() || probes.board.probes > 0)) {
      return "shade.lamp.given = true needs a map (localization.map), from which shadows are computed, and no probes "
             "(probes.board.probes): they find the lamp";
    }
    if (auto wrong = map_inconsistency(); !wrong.empty()) return wrong;
    if (probes.board.probes == 0 && !(switches.probe_lamp_line.empty() && switches.room_lamp_line.empty())) {
      return "switches.probe_lamp_line and room_lamp_line need probes (probes.board.probes): what they change is "
             "judged "
             "by the probes' shadows";
    }
    if (live && simulated_camera()) {
      return "run.pace = \"live\" does not go with camera.kind = \"sim\", which is not rendered in real time: "
             "lock_step "
             "or real_time";
    }
    if (!live && real()) {
      return "devices of this computer (camera.kind = \"v4l2\", base.can = \"socketcan\", switches.kind = \"gpiod\") "
             "need run.pace = \"live\"";
    }
    if (camera.kind != CameraKind::kReplay) return "";
    const bool own_rate = camera.replay.pace == hal::ReplayPace::kOwnRate;
    if (live && !own_rate)
      return "run.pace = \"live\" needs camera.replay.pace = \"own_rate\": images must come in real time";
    if (!live && own_rate)
      return "run.pace = \"lock_step\" or \"real_time\" needs camera.replay.pace = \"as_fast_as_possible\": the stamps "
             "are the time";
    return "";
  }
};

}  // namespace cgsr::config
