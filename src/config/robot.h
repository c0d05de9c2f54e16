#pragma once

#include <array>
#include <string>

#include "hal/dummy/kinematic_drive.h"
#include "hal/replay/replay_camera.h"
#include "pipeline/behavior/follow.h"
#include "pipeline/motion_limits.h"
#include "pipeline/vision_loop.h"
#include "pipeline/vision_stages.h"
#include "src/config/color.h"

namespace cgsr::config {

enum class Pace : std::uint8_t {
  kLockStep,  ///< one thread steps everything, the stamps are the time: as fast as it goes, the same bytes every time.
  kLive,      ///< every task has its thread and the clock is real.
};
inline constexpr std::array kPaceNames{Named<Pace>{"lock_step", Pace::kLockStep}, Named<Pace>{"live", Pace::kLive}};

struct Run {
  Pace pace = Pace::kLockStep;
  double result_latency_s = 0.033;
  std::string model;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("pace", self.pace, kPaceNames, "lock_step: the stamps are the time; live: a thread per task");
    visit.number("result_latency_s", self.result_latency_s, {0.0, 0.5}, "s",
                 "in lock-step: from an image's stamp until its result reaches motion, however slow the machine");
    visit.text("model", self.model, "the object to follow: a file that cgsr learn wrote");
  }
};

struct Camera {
  Pinhole pinhole;
  hal::ReplayParameters replay;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("pinhole", self.pinhole, "The optics of the images that the camera delivers");
    visit.section("replay", self.replay, "Video files and image folders as a camera");
  }
};

struct Switches {
  std::string arming_line;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("arming_line", self.arming_line,
               "input whose rising edge arms the robot and whose falling edge disarms it; empty: none");
  }
};

/// Everything a robot's file says (config/robots/*.toml). Each section's struct lives with the code that it steers.
struct Robot {
  Run run;
  Camera camera;
  hal::KinematicDriveParameters drive;
  Switches switches;
  VisionStages stage;
  Color color;
  behavior::FollowParameters follow;
  MotionParameters motion;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("run", self.run, "How the program runs, and after what");
    visit.section("camera", self.camera, "Where images come from");
    visit.section("drive", self.drive, "The base: a unicycle without wheels, until there is a real one");
    visit.section("switches", self.switches, "Named lines");
    visit.section("stage", self.stage, "The schedule: which stage runs in which frame and what it may cost");
    visit.section("color", self.color, "Colour tracking (chapter 3)");
    visit.section("follow", self.follow, "Following an object: how close, how fast, and what to do when it is gone");
    visit.section("motion", self.motion, "How fast the wheels may be told to go, and when they are told to stop");
  }

  /// \return what is wrong with the sections together; empty when nothing is.
  [[nodiscard]] std::string inconsistency() const {
    const bool live = run.pace == Pace::kLive;
    const bool own_rate = camera.replay.pace == hal::ReplayPace::kOwnRate;
    if (live && !own_rate)
      return "run.pace = \"live\" needs camera.replay.pace = \"own_rate\": images must come in real time";
    if (!live && own_rate)
      return "run.pace = \"lock_step\" needs camera.replay.pace = \"as_fast_as_possible\": the stamps are the time";
    return "";
  }
};

}  // namespace cgsr::config
