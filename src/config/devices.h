#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "hal/dummy/kinematic_drive.h"
#include "hal/replay/replay_camera.h"
#include "hal/rmp/parameters.h"
#include "pipeline/illumination/lamp.h"
#include "pipeline/stages/switchboard.h"
#include "platform/parameters.h"

namespace cgsr::config {

// The kinds of each device. Any mix works. The factory of a kind stands in src/boot/device_kinds.cpp: a new kind is its name here, the section
// of its parameters, and a row there.

enum class CameraKind : std::uint8_t { kReplay, kSim };
inline constexpr std::array kCameraKindNames{Named<CameraKind>{"replay", CameraKind::kReplay},
                                             Named<CameraKind>{"sim", CameraKind::kSim}};

enum class BaseKind : std::uint8_t { kKinematic, kRmp };
inline constexpr std::array kBaseKindNames{Named<BaseKind>{"kinematic", BaseKind::kKinematic},
                                           Named<BaseKind>{"rmp", BaseKind::kRmp}};

enum class CanKind : std::uint8_t { kSim };
inline constexpr std::array kCanKindNames{Named<CanKind>{"sim", CanKind::kSim}};

enum class SwitchesKind : std::uint8_t { kDummy, kSim };
inline constexpr std::array kSwitchesKindNames{Named<SwitchesKind>{"dummy", SwitchesKind::kDummy},
                                               Named<SwitchesKind>{"sim", SwitchesKind::kSim}};

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
  CameraKind kind = CameraKind::kReplay;
  Pinhole pinhole;
  hal::ReplayParameters replay;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("kind", self.kind, kCameraKindNames,
                 "The camera: replay reads files ([camera.replay]), sim sees the simulated home ([sim]).");
    visit.section("pinhole", self.pinhole, "The optics of the camera's images");
    visit.section("replay", self.replay, "Video files and image folders as a camera (camera.kind = \"replay\")");
  }
};

struct Base {
  BaseKind kind = BaseKind::kKinematic;
  CanKind can = CanKind::kSim;
  hal::KinematicDriveParameters kinematic;
  hal::rmp::RmpParameters rmp;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("kind", self.kind, kBaseKindNames,
                 "The base: kinematic is an ideal unicycle without wheels ([base.kinematic]), rmp is a Segway on the "
                 "CAN bus that base.can names ([base.rmp]).");
    visit.choice("can", self.can, kCanKindNames,
                 "The CAN bus of the base with base.kind = \"rmp\": sim is the bus of the simulated home ([sim]).");
    visit.section("kinematic", self.kinematic, "An ideal unicycle as a base (base.kind = \"kinematic\")");
    visit.section("rmp", self.rmp, "The Segway on a CAN bus (base.kind = \"rmp\")");
  }
};

struct Switches {
  SwitchesKind kind = SwitchesKind::kDummy;
  std::string arming_line;
  std::string probe_lamp_line;
  std::string room_lamp_line;
  std::string fill_light_line;
  double answer_timeout_s = 0.5;
  illumination::ProbeLampParameters probe_lamp;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("kind", self.kind, kSwitchesKindNames,
                 "The lines: dummy keeps the named lines in memory and switches nothing, sim has those of the "
                 "simulated home ([sim]).");
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

}  // namespace cgsr::config
