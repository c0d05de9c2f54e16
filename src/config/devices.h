#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "hal/dummy/kinematic_drive.h"
#include "hal/replay/replay_camera.h"
#include "hal/rmp/parameters.h"
#include "hal/socketcan/parameters.h"
#include "hal/v4l2/parameters.h"
#include "pipeline/illumination/lamp.h"
#include "pipeline/stages/switchboard.h"
#include "platform/parameters.h"

namespace cgsr::config {

// The kinds of each device. Any mix works. The factory of a kind stands in src/boot/device_kinds.cpp: a new kind is its name here, the section
// of its parameters, and a row there.

enum class CameraKind : std::uint8_t { kReplay, kSim, kV4l2 };
inline constexpr std::array kCameraKindNames{Named<CameraKind>{"replay", CameraKind::kReplay},
                                             Named<CameraKind>{"sim", CameraKind::kSim},
                                             Named<CameraKind>{"v4l2", CameraKind::kV4l2}};
constexpr std::string_view to_string(CameraKind kind) {
  return word_in(kCameraKindNames, kind);
}

enum class BaseKind : std::uint8_t { kKinematic, kRmp };
inline constexpr std::array kBaseKindNames{Named<BaseKind>{"kinematic", BaseKind::kKinematic},
                                           Named<BaseKind>{"rmp", BaseKind::kRmp}};
constexpr std::string_view to_string(BaseKind kind) {
  return word_in(kBaseKindNames, kind);
}

enum class CanKind : std::uint8_t { kSim, kSocketCan };
inline constexpr std::array kCanKindNames{Named<CanKind>{"sim", CanKind::kSim},
                                          Named<CanKind>{"socketcan", CanKind::kSocketCan}};
constexpr std::string_view to_string(CanKind kind) {
  return word_in(kCanKindNames, kind);
}

enum class SwitchesKind : std::uint8_t { kDummy, kSim, kGpiod };
inline constexpr std::array kSwitchesKindNames{Named<SwitchesKind>{"dummy", SwitchesKind::kDummy},
                                               Named<SwitchesKind>{"sim", SwitchesKind::kSim},
                                               Named<SwitchesKind>{"gpiod", SwitchesKind::kGpiod}};
constexpr std::string_view to_string(SwitchesKind kind) {
  return word_in(kSwitchesKindNames, kind);
}

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
  hal::v4l2::V4l2Parameters v4l2;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("kind", self.kind, kCameraKindNames,
                 "The camera: replay reads files ([camera.replay]), sim sees the simulated home ([sim]), v4l2 is a "
                 "camera of this computer ([camera.v4l2]).");
    visit.section("pinhole", self.pinhole, "The optics of the camera's images");
    visit.section("replay", self.replay, "Video files and image folders as a camera (camera.kind = \"replay\")");
    visit.section("v4l2", self.v4l2, "A camera of this computer (camera.kind = \"v4l2\")");
  }
};

struct Base {
  BaseKind kind = BaseKind::kKinematic;
  CanKind can = CanKind::kSim;
  hal::KinematicDriveParameters kinematic;
  hal::rmp::RmpParameters rmp;
  hal::socketcan::SocketCanParameters socketcan;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("kind", self.kind, kBaseKindNames,
                 "The base: kinematic is an ideal unicycle without wheels ([base.kinematic]), rmp is a Segway on the "
                 "CAN bus that base.can names ([base.rmp]).");
    visit.choice("can", self.can, kCanKindNames,
                 "The CAN bus of the base with base.kind = \"rmp\": sim is the bus of the simulated home ([sim]), "
                 "socketcan a CAN interface of this computer ([base.socketcan]).");
    visit.section("kinematic", self.kinematic, "An ideal unicycle as a base (base.kind = \"kinematic\")");
    visit.section("rmp", self.rmp, "The Segway on a CAN bus (base.kind = \"rmp\")");
    visit.section("socketcan", self.socketcan, "A CAN interface of this computer (base.can = \"socketcan\")");
  }
};

/// Which of the named lines are on when their level is low.
struct GpiodLevels {
  bool arming_active_low = false;
  bool probe_lamp_active_low = false;
  bool room_lamp_active_low = false;
  bool fill_light_active_low = false;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.flag("arming_active_low", self.arming_active_low, "The arming line is on when its level is low.");
    visit.flag("probe_lamp_active_low", self.probe_lamp_active_low,
               "The probe lamp's line is on when its level is low.");
    visit.flag("room_lamp_active_low", self.room_lamp_active_low, "The room lamp's line is on when its level is low.");
    visit.flag("fill_light_active_low", self.fill_light_active_low,
               "The fill light's line is on when its level is low.");
  }

  /// By LampLine.
  [[nodiscard]] std::array<bool, stages::kLampLines> lamps() const {
    return {probe_lamp_active_low, room_lamp_active_low, fill_light_active_low};
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
  GpiodLevels gpiod;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("kind", self.kind, kSwitchesKindNames,
                 "The lines: dummy keeps the named lines in memory and switches nothing, sim has those of the "
                 "simulated home ([sim]), gpiod those of this computer, by the line's own name or as CHIP:OFFSET, such "
                 "as gpiochip0:17 ([switches.gpiod]).");
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
    visit.section("gpiod", self.gpiod, "The levels of this computer's lines (switches.kind = \"gpiod\")");
  }

  /// By LampLine.
  [[nodiscard]] std::array<std::string, stages::kLampLines> lamps() const {
    return {probe_lamp_line, room_lamp_line, fill_light_line};
  }
};

}  // namespace cgsr::config
