#pragma once

#include <array>
#include <string>

#include "hal/dummy/kinematic_drive.h"
#include "hal/replay/replay_camera.h"
#include "hal/rmp/parameters.h"
#include "hal/simulation.h"
#include "pipeline/behavior/follow.h"
#include "pipeline/color/ball/integrated_tracker.h"
#include "pipeline/illumination/lamp.h"
#include "pipeline/motion/motion_limits.h"
#include "pipeline/stages/odometry_track.h"
#include "pipeline/vision_loop.h"
#include "platform/config/provenance.h"
#include "src/config/color.h"
#include "src/config/light.h"
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

/// The pinhole of the camera that the images come from (frames: docs/frames.md), where no calibration says more.
struct Pinhole {
  double fx_px = 601.8;
  double fy_px = 579.4;
  double cx_px = 319.5;
  double cy_px = 239.5;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("fx_px", self.fx_px, {10.0, 20000.0}, "px", "The focal length along x.");
    visit.number("fy_px", self.fy_px, {10.0, 20000.0}, "px", "The focal length along y.");
    visit.number("cx_px", self.cx_px, {-10000.0, 20000.0}, "px", "The column of the optical axis.");
    visit.number("cy_px", self.cy_px, {-10000.0, 20000.0}, "px", "The row of the optical axis.");
  }
};

struct Camera {
  CameraSource source = CameraSource::kReplay;
  Pinhole pinhole;
  hal::ReplayParameters replay;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("source", self.source, kCameraSourceNames,
                 "Choose replay for files; sim is the simulated home, together with the base on its virtual CAN bus "
                 "and its lines.");
    visit.section("pinhole", self.pinhole, "The optics of the camera's images");
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
               "The input line whose rising edge arms the robot and whose falling edge disarms it; empty means none.");
    visit.text("probe_lamp_line", self.probe_lamp_line,
               "The output line that switches the lamp on the probe board, whose shadows check board and probes before "
               "they are used; empty means none.");
    visit.text("room_lamp_line", self.room_lamp_line,
               "The output line that switches the room's lamp, possibly beside a wall switch; the shadow that changes "
               "with it is the lamp's; empty means none.");
    visit.text("fill_light_line", self.fill_light_line,
               "The output line that switches a light on faces; empty means none.");
    visit.number("answer_timeout_s", self.answer_timeout_s, {0.06, 10.0}, "s",
                 "A line that has not acknowledged after this time counts as failed.");
    visit.section("probe_lamp", self.probe_lamp, "The lamp on the probe board");
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
  Mount mount;
  color::IntegratedParameters integrated;
  illumination::ProbesParameters probes;
  illumination::LampParameters lamp;
  stages::ShadeStageParameters shade;
  Task task;
  behavior::FollowParameters follow;
  MotionParameters motion;
  Provenance provenance;  ///< where the values came from; not a value itself.

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("run", self.run, "How the program runs");
    visit.section("camera", self.camera, "The source of the images");
    visit.section("sim", self.sim, "The simulated home (camera.source = \"sim\")");
    visit.section("drive", self.drive, "The base that is used with replayed images: an ideal unicycle");
    visit.section("rmp", self.rmp, "The Segway on a CAN bus: the base of the simulated home");
    visit.section("switches", self.switches, "Named input and output lines");
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
    visit.section("task", self.task, "The task of the robot");
    visit.section("follow", self.follow, "Following an object: distance, speed and the reaction to a loss");
    visit.section("motion", self.motion, "The limits of wheel commands and the conditions for a stop");
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
