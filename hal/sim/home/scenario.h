#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hal/sim/base/base_parameters.h"
#include "hal/sim/base/simulated_rmp.h"
#include "hal/sim/base/virtual_can_bus.h"
#include "hal/sim/switches/simulated_switches.h"
#include "hal/sim/worlds/world_spec.h"
#include "platform/parameters.h"

namespace cgsr::sim {

inline constexpr double kForEver_s = 86400.0;

/// [camera]: how the robot's camera measures.
struct CameraSpec {
  bool distortion = true;
  bool noise = true;
  bool automatic_exposure = false;
  int blur_moments = 1;
  int edge_samples = 4;
  double height_m = 0.0;
  double down_deg = 0.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.flag("distortion", self.distortion, "the lens bends straight lines");
    visit.flag("noise", self.noise, "shot and read noise");
    visit.flag("automatic_exposure", self.automatic_exposure, "exposure and gain follow the mean brightness");
    visit.number("blur_moments", self.blur_moments, {1, 64}, "", "moments of an exposure that are drawn; 1: no blur");
    visit.number("edge_samples", self.edge_samples, {1, 16}, "", "rays for a pixel at an edge: 1, 4 or 16");
    visit.number("height_m", self.height_m, {0.0, 5.0}, "m",
                 "of the optical centre; 0: as the world has robot and tilt");
    visit.number("down_deg", self.down_deg, {-80.0, 80.0}, "deg", "tilt below the horizon where height_m is given");
  }
  [[nodiscard]] std::string inconsistency() const {
    return edge_samples == 1 || edge_samples == 4 || edge_samples == 16 ? "" : "edge_samples is not 1, 4 or 16";
  }
};

enum class CameraTrouble : std::uint8_t { kDropped, kFrozen, kCorrupt, kLate, kGone };
inline constexpr Named<CameraTrouble> kCameraTroubleNames[] = {{"dropped", CameraTrouble::kDropped},
                                                               {"frozen", CameraTrouble::kFrozen},
                                                               {"corrupt", CameraTrouble::kCorrupt},
                                                               {"late", CameraTrouble::kLate},
                                                               {"gone", CameraTrouble::kGone}};
constexpr std::string_view to_string(CameraTrouble trouble) {
  return word_in(kCameraTroubleNames, trouble);
}

/// [[camera_event]]
struct CameraEventSpec {
  CameraTrouble what = CameraTrouble::kDropped;
  double from_s = 0.0;
  double to_s = kForEver_s;
  double late_s = 0.1;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("what", self.what, kCameraTroubleNames, "what happens to the images");
    visit.number("from_s", self.from_s, kTime_s, "s", "from then on");
    visit.number("to_s", self.to_s, kTime_s, "s", "until just before then");
    visit.number("late_s", self.late_s, {0.0, 10.0}, "s", "how late; what would have come meanwhile is lost");
  }
};

inline constexpr Named<BusTrouble> kBusTroubleNames[] = {{"base_silent", BusTrouble::kBaseSilent},
                                                         {"id_lost", BusTrouble::kIdLost},
                                                         {"unplugged", BusTrouble::kUnplugged},
                                                         {"bus_off", BusTrouble::kBusOff},
                                                         {"gone", BusTrouble::kGone},
                                                         {"second_commander", BusTrouble::kSecondCommander}};
constexpr std::string_view to_string(BusTrouble trouble) {
  return word_in(kBusTroubleNames, trouble);
}

/// [[bus_event]]
struct BusEventSpec {
  BusTrouble what = BusTrouble::kBaseSilent;
  double from_s = 0.0;
  double to_s = kForEver_s;
  int id = 0x413;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("what", self.what, kBusTroubleNames, "what happens to the CAN bus");
    visit.number("from_s", self.from_s, kTime_s, "s", "from then on");
    visit.number("to_s", self.to_s, kTime_s, "s", "until just before then");
    visit.number("id", self.id, {0, 0x7FF}, "", "id_lost: which; second_commander: of its frames, 1043 is a command");
  }
};

inline constexpr Named<BaseTrouble> kBaseTroubleNames[] = {{"emergency_stop", BaseTrouble::kEmergencyStop},
                                                           {"low_battery", BaseTrouble::kLowBattery},
                                                           {"safety_shutdown", BaseTrouble::kSafetyShutdown},
                                                           {"motors_off", BaseTrouble::kMotorsOff},
                                                           {"power_off", BaseTrouble::kPowerOff},
                                                           {"status_bits", BaseTrouble::kStatusBits}};
constexpr std::string_view to_string(BaseTrouble trouble) {
  return word_in(kBaseTroubleNames, trouble);
}

/// [[base_event]]
struct BaseEventSpec {
  BaseTrouble what = BaseTrouble::kEmergencyStop;
  double from_s = 0.0;
  double to_s = kForEver_s;
  int word1 = 0;
  int word2 = 0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("what", self.what, kBaseTroubleNames, "what happens to the base");
    visit.number("from_s", self.from_s, kTime_s, "s", "from then on");
    visit.number("to_s", self.to_s, kTime_s, "s", "until just before then");
    visit.number("word1", self.word1, {0, 0xFFFF}, "", "bits of status word 1 on top");
    visit.number("word2", self.word2, {0, 0xFFFF}, "", "bits of status word 2 on top");
  }
};

/// [[line]]: what the robot's computer can switch or read.
struct LineSpec {
  std::string name;
  bool input = false;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("name", self.name, "what the robot and the world's lamps call it");
    visit.flag("input", self.input, "read by the robot, such as the arming switch; else switched by it");
  }
};

inline constexpr Named<SwitchHappening> kSwitchHappeningNames[] = {{"pressed", SwitchHappening::kPressed},
                                                                   {"no_answer", SwitchHappening::kNoAnswer},
                                                                   {"stuck", SwitchHappening::kStuck}};
constexpr std::string_view to_string(SwitchHappening happening) {
  return word_in(kSwitchHappeningNames, happening);
}

/// [[line_event]]
struct LineEventSpec {
  SwitchHappening what = SwitchHappening::kPressed;
  std::string line;
  double from_s = 0.0;
  double to_s = kForEver_s;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("what", self.what, kSwitchHappeningNames, "what happens to the line");
    visit.text("line", self.line, "which");
    visit.number("from_s", self.from_s, kTime_s, "s", "from then on");
    visit.number("to_s", self.to_s, kTime_s, "s", "until just before then");
  }
};

/// [[wall_switch]]: somebody's hand. A lamp is a two-way circuit of the wall's switch and the robot's line of its name:
/// it burns when exactly one of them is on.
struct WallSwitchSpec {
  std::string lamp_line;
  double at_s = 0.0;
  bool on = true;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("lamp_line", self.lamp_line, "the world's name of the lamps' switch");
    visit.number("at_s", self.at_s, kTime_s, "s", "from then on");
    visit.flag("on", self.on, "the wall's switch is on");
  }
};

/// [[light]]: another script for a lamp of the world.
struct LightScriptSpec {
  std::string lamp;
  double radius_m = 0.0;
  std::vector<LightKeySpec> script;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("lamp", self.lamp, "name of the lamp; empty: the light from everywhere");
    visit.number("radius_m", self.radius_m, {0.0, 1.0}, "m", "a ball of light so large; 0: as the world says");
    visit.list("script", self.script, "what it does over time");
  }
};

/// [[actor]]: another script for somebody or something of the world.
struct ActorScriptSpec {
  std::string name;
  double astray_m = 0.0;
  WalkSpec walk;
  std::vector<PresenceSpec> presence;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("name", self.name, "of an object, ball or person of the world");
    visit.number("astray_m", self.astray_m, {0.0, 2.0}, "m",
                 "its stops but the first are moved by up to this, by the seed");
    visit.section("walk", self.walk, "where it goes");
    visit.list("presence", self.presence, "when it is there");
  }
};

/// [[object_part]]: what of the object counts, such as a shirt.
struct ObjectPartSpec {
  std::string name;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("name", self.name, "of a piece of the object");
  }
};

/// [start]: where the robot begins, instead of where the world has it.
struct StartSpec {
  bool given = false;
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_deg = 0.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.flag("given", self.given, "off: where the world has it");
    visit.number("x_m", self.x_m, {-1000.0, 1000.0}, "m", "on the floor");
    visit.number("y_m", self.y_m, {-1000.0, 1000.0}, "m", "on the floor");
    visit.number("heading_deg", self.heading_deg, {-360.0, 360.0}, "deg", "where it looks");
  }
};

/// A scenario file: a world, what happens in it, and what goes wrong.
struct ScenarioSpec {
  std::string world;
  std::string robot;
  std::string object;
  double ends_at_s = kForEver_s;
  std::vector<ObjectPartSpec> object_part;
  StartSpec start;
  CameraSpec camera;
  BaseParameters base;
  std::vector<LineSpec> line;
  std::vector<MaterialSpec> material;
  std::vector<BallSpec> ball;
  std::vector<LampSpec> lamp;
  std::vector<PersonSpec> person;
  std::vector<ActorScriptSpec> actor;
  std::vector<LightScriptSpec> light;
  std::vector<WallSwitchSpec> wall_switch;
  std::vector<LineEventSpec> line_event;
  std::vector<CameraEventSpec> camera_event;
  std::vector<BusEventSpec> bus_event;
  std::vector<BaseEventSpec> base_event;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("world", self.world, "the world's file, beside this one");
    visit.text("robot", self.robot, "which of its robots drives; empty: the first");
    visit.text("object", self.object, "whom the robot shall follow: truth speaks of it; empty: of nobody");
    visit.number("ends_at_s", self.ends_at_s, kTime_s, "s", "the camera ends then, and the run with it");
    visit.list("object_part", self.object_part, "What of the object counts for its box; none: all of it");
    visit.section("start", self.start, "Where the robot begins");
    visit.section("camera", self.camera, "How the camera measures");
    visit.section("base", self.base, "The simulated Segway");
    visit.list("line", self.line, "Lines of the robot's computer");
    visit.list("material", self.material, "Surfaces that the world does not have");
    visit.list("ball", self.ball, "Balls that the world does not have");
    visit.list("lamp", self.lamp, "Lamps that the world does not have");
    visit.list("person", self.person, "People whom the world does not have");
    visit.list("actor", self.actor, "What moves otherwise than the world says");
    visit.list("light", self.light, "Lamps that change");
    visit.list("wall_switch", self.wall_switch, "Switches in the wall; off before the first");
    visit.list("line_event", self.line_event, "What happens to lines");
    visit.list("camera_event", self.camera_event, "What happens to images");
    visit.list("bus_event", self.bus_event, "What happens to the bus");
    visit.list("base_event", self.base_event, "What happens to the base");
  }
};

/// A scenario with its world, ready to be built.
struct Scenario {
  ScenarioSpec spec;
  WorldSpec world;
  std::filesystem::path world_file;
};

/// Reads a scenario and its world, and writes the scenario's scripts into the world.
///
/// \param seed  moves the stops of actors that may go astray.
/// \return the scenario, or every problem, a line each.
Result<Scenario> load_scenario(const std::filesystem::path& file, std::uint32_t seed);

}  // namespace cgsr::sim
