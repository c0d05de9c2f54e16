#pragma once

#include <array>
#include <string>

#include "hal/dummy/kinematic_drive.h"
#include "hal/replay/replay_camera.h"
#include "hal/rmp/parameters.h"
#include "hal/simulation.h"
#include "pipeline/behavior/follow.h"
#include "pipeline/color/integrated_tracker.h"
#include "pipeline/illumination/lamp.h"
#include "pipeline/motion/motion_limits.h"
#include "pipeline/stages/odometry_track.h"
#include "pipeline/vision_loop.h"
#include "src/config/color.h"
#include "src/config/whereabouts.h"

namespace cgsr::config {

enum class Pace : std::uint8_t {
  kLockStep,  ///< one thread steps everything, the stamps are the time: as fast as it goes, the same bytes every time.
  kRealTime,  ///< the same, but no faster than the clock: time slows where images take longer, and none is dropped.
  kLive,      ///< every task has its thread and the clock is real.
};
inline constexpr std::array kPaceNames{Named<Pace>{"lock_step", Pace::kLockStep},
                                       Named<Pace>{"real_time", Pace::kRealTime}, Named<Pace>{"live", Pace::kLive}};

enum class CameraSource : std::uint8_t { kReplay, kSim };
inline constexpr std::array kCameraSourceNames{Named<CameraSource>{"replay", CameraSource::kReplay},
                                               Named<CameraSource>{"sim", CameraSource::kSim}};

/// Where in the first image the object is that shall be followed. No width: it is not learned so.
struct LearnRegion {
  int x_px = 0;
  int y_px = 0;
  int width_px = 0;
  int height_px = 0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("x_px", self.x_px, {0, 8192}, "px", "left edge");
    visit.number("y_px", self.y_px, {0, 8192}, "px", "upper edge");
    visit.number("width_px", self.width_px, {0, 8192}, "px", "0: nothing is learned");
    visit.number("height_px", self.height_px, {0, 8192}, "px", "0: nothing is learned");
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
    visit.choice(
        "pace", self.pace, kPaceNames,
        "lock_step: the stamps are the time; real_time: likewise, but no faster than the clock; live: a thread "
        "per task");
    visit.number("result_latency_s", self.result_latency_s, {0.0, 0.5}, "s",
                 "in lock-step: from an image's stamp until its result reaches motion, however slow the machine");
    visit.text("model", self.model, "the object to follow: a file that cgsr learn wrote");
    visit.section("learn", self.learn, "Without a model: what lies here in the first image is learned and followed");
  }
};

/// The pinhole of the camera that the images come from (frames: docs/frames.md), where no calibration says more.
struct Pinhole {
  double fx_px = 601.8;
  double fy_px = 579.4;
  double cx_px = 319.5;
  double cy_px = 239.5;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("fx_px", self.fx_px, {10.0, 20000.0}, "px", "focal length along x");
    visit.number("fy_px", self.fy_px, {10.0, 20000.0}, "px", "focal length along y");
    visit.number("cx_px", self.cx_px, {-10000.0, 20000.0}, "px", "column of the optical axis");
    visit.number("cy_px", self.cy_px, {-10000.0, 20000.0}, "px", "row of the optical axis");
  }
};

struct Camera {
  CameraSource source = CameraSource::kReplay;
  Pinhole pinhole;
  hal::ReplayParameters replay;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("source", self.source, kCameraSourceNames,
                 "replay: files; sim: the simulated home, and with it the base on its virtual CAN bus and the lines");
    visit.section("pinhole", self.pinhole, "The optics of the images that the camera delivers");
    visit.section("replay", self.replay, "Video files and image folders as a camera");
  }
};

struct Switches {
  std::string arming_line;
  std::string probe_lamp_line;
  std::string room_lamp_line;
  std::string fill_light_line;
  double answer_timeout_s = 0.5;
  illumination::ProbeLampParameters probe_lamp;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("arming_line", self.arming_line,
               "input whose rising edge arms the robot and whose falling edge disarms it; empty: none");
    visit.text("probe_lamp_line", self.probe_lamp_line,
               "output that switches the probe board's own lamp; its shadows check board and probes before they are "
               "trusted; empty: none");
    visit.text("room_lamp_line", self.room_lamp_line,
               "output that switches the room's lamp, also beside a switch in the wall: what changes with it is its "
               "shadow; empty: none");
    visit.text("fill_light_line", self.fill_light_line, "output that switches a light on faces; empty: none");
    visit.number("answer_timeout_s", self.answer_timeout_s, {0.06, 10.0}, "s",
                 "a line that has not acknowledged by then counts as one that does not answer");
    visit.section("probe_lamp", self.probe_lamp, "The probe board's own lamp");
  }

  /// By LampLine.
  [[nodiscard]] std::array<std::string, stages::kLampLines> lamps() const {
    return {probe_lamp_line, room_lamp_line, fill_light_line};
  }
};

/// Everything a robot's file says (config/robots/*.toml). Each section's struct lives with the code that it steers.
struct Robot {
  Run run;
  Camera camera;
  hal::SimulationParameters sim;
  hal::KinematicDriveParameters drive;
  hal::rmp::RmpParameters rmp;
  Switches switches;
  VisionStages stage;
  Color color;
  RobotLocalization localization;
  stages::OdometryScales odometry;
  color::IntegratedParameters integrated;
  illumination::ProbesParameters probes;
  illumination::LampParameters lamp;
  stages::ShadeStageParameters shade;
  Task task;
  behavior::FollowParameters follow;
  MotionParameters motion;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("run", self.run, "How the program runs, and after what");
    visit.section("camera", self.camera, "Where images come from");
    visit.section("sim", self.sim, "The simulated home (camera.source = \"sim\")");
    visit.section("drive", self.drive, "The base that goes with replayed images: a unicycle without wheels");
    visit.section("rmp", self.rmp, "The Segway on a CAN bus: the base of the simulated home");
    visit.section("switches", self.switches, "Named lines");
    visit.section("stage", self.stage, "The schedule: which stage runs in which frame and what it may cost");
    visit.section("color", self.color, "Colour tracking (chapter 3)");
    visit.section("localization", self.localization, "Where the robot is (chapter 4)");
    visit.section("odometry", self.odometry, "What the base reports of its way, scaled before it carries the pose");
    visit.section("integrated", self.integrated,
                  "A ball, bright everywhere and dark where there may be shade (5.3; task.kind = \"lamp\")");
    visit.section("probes", self.probes, "The probe board and how it is looked at (Alg. 5.1)");
    visit.section("lamp", self.lamp, "What is known of lamps, and how observations become one (Eq. 5.1, 5.2)");
    visit.section("shade", self.shade, "What lies in the lamp's shadow (5.2)");
    visit.section("task", self.task, "What the robot does");
    visit.section("follow", self.follow, "Following an object: how close, how fast, and what to do when it is gone");
    visit.section("motion", self.motion, "How fast the wheels may be told to go, and when they are told to stop");
  }

  /// \return what is wrong with the sections together; empty when nothing is.
  [[nodiscard]] std::string inconsistency() const {
    const bool live = run.pace == Pace::kLive;
    if (task.kind != TaskKind::kFollow && localization.map.empty()) {
      return "task.kind = \"route\" and \"lamp\" need a map (localization.map): places mean nothing to a robot without "
             "one";
    }
    if (probes.board.probes > 0 && (localization.camera.empty() || localization.mount.empty())) {
      return "probes.board needs localization.camera and localization.mount: shadows are measured through them";
    }
    if (!localization.map.empty() && (localization.camera.empty() || localization.mount.empty())) {
      return "localization.map needs localization.camera and localization.mount beside it";
    }
    if (probes.board.probes == 0 && !(switches.probe_lamp_line.empty() && switches.room_lamp_line.empty())) {
      return "switches.probe_lamp_line and room_lamp_line need probes (probes.board.probes): what they change is "
             "judged "
             "by the probes' shadows";
    }
    if (camera.source == CameraSource::kSim) {
      return live ? "run.pace = \"live\" does not go with camera.source = \"sim\": lock_step or real_time" : "";
    }
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
