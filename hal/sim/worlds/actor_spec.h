#pragma once

#include <array>
#include <string>
#include <vector>

#include "hal/sim/people/person.h"
#include "hal/sim/worlds/shape_spec.h"

namespace cgsr::sim {

/// One stop of a walk.
struct StopSpec {
  static constexpr double kAsItCame = -1000.0;  // outside the range: not given
  Triple at_m{0.0, 0.0, 0.0};
  double speed_mps = 0.5;
  double wait_s = 0.0;
  double heading_deg = kAsItCame;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.numbers("at_m", self.at_m, kAnywhere_m, "m", "where");
    visit.number("speed_mps", self.speed_mps, {0.01, 20.0}, "m/s", "on the way here");
    visit.number("wait_s", self.wait_s, kTime_s, "s", "how long it stands here");
    visit.number("heading_deg", self.heading_deg, kAngle_deg, "deg", "where it looks meanwhile; default: as it came");
  }
};

/// Where something goes over time.
struct WalkSpec {
  double start_s = 0.0;
  double turn_degps = 120.0;
  bool loops = false;
  std::vector<StopSpec> stop;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("start_s", self.start_s, kTime_s, "s", "stands at its first stop until then");
    visit.number("turn_degps", self.turn_degps, {1.0, 3600.0}, "deg/s", "how fast it turns");
    visit.flag("loops", self.loops, "goes from the last stop to the first and on");
    visit.list("stop", self.stop, "the places, in order");
  }
};

/// From when on something is there, and in which outfit.
struct PresenceSpec {
  double at_s = 0.0;
  bool present = true;
  int outfit = 0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("at_s", self.at_s, kTime_s, "s", "from then on");
    visit.flag("present", self.present, "is it there");
    visit.number("outfit", self.outfit, {0, 15}, "", "which of its outfits it wears");
  }
};

/// [[ball]]: rolls along its walk.
struct BallSpec {
  int line = 0;
  std::string name = "ball";
  std::string material;
  double radius_m = 0.10;
  WalkSpec walk;
  std::vector<PresenceSpec> presence;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.line(self.line);
    visit.text("name", self.name, "for messages and truth");
    visit.text("material", self.material, "its surface");
    visit.number("radius_m", self.radius_m, {0.005, 10.0}, "m", "radius; its path is that of its lowest point");
    visit.section("walk", self.walk, "where it rolls");
    visit.list("presence", self.presence, "when it is there");
  }
};

/// [[object]]: shapes that move as one; x is where it goes.
struct ObjectSpec {
  int line = 0;
  std::string name = "object";
  std::vector<ShapeSpec> shape;
  WalkSpec walk;
  std::vector<PresenceSpec> presence;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.line(self.line);
    visit.text("name", self.name, "for messages and truth");
    visit.list("shape", self.shape, "its pieces, as [[shape]] but in its own frame");
    visit.section("walk", self.walk, "where it goes");
    visit.list("presence", self.presence, "when it is there");
  }
};

/// What a person wears.
struct OutfitSpec {
  ShirtKind shirt = ShirtKind::kPlain;
  Triple color{0.2, 0.3, 0.6};
  Triple second{0.9, 0.9, 0.9};
  Triple trousers{0.16, 0.17, 0.22};
  int marker = -1;
  int back_marker = -1;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("shirt", self.shirt, kShirtNames, "plain, striped or two_coloured");
    visit.numbers("color", self.color, kShare, "sRGB", "of the shirt");
    visit.numbers("second", self.second, kShare, "sRGB", "its stripes or its lower half");
    visit.numbers("trousers", self.trousers, kShare, "sRGB", "of the trousers");
    visit.number("marker", self.marker, {-1, 49}, "", "ArUco marker 4x4_50 on the chest; -1: none");
    visit.number("back_marker", self.back_marker, {-1, 49}, "", "the same on the back");
  }
};

/// Where a head looks from a time on.
struct HeadSpec {
  double at_s = 0.0;
  double yaw_deg = 0.0;
  double pitch_deg = 0.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("at_s", self.at_s, kTime_s, "s", "from then on");
    visit.number("yaw_deg", self.yaw_deg, {-90.0, 90.0}, "deg", "to the left of where the body faces");
    visit.number("pitch_deg", self.pitch_deg, {-45.0, 45.0}, "deg", "down");
  }
};

/// [[person]]
struct PersonSpec {
  int line = 0;
  std::string name = "person";
  int identity = 0;
  double height_m = 1.72;
  std::vector<OutfitSpec> outfit;
  std::vector<HeadSpec> head;
  std::vector<PresenceSpec> presence;
  WalkSpec walk;
  bool watches_robot = false;
  double makes_way_m = 0.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.line(self.line);
    visit.text("name", self.name, "for messages and truth");
    visit.number("identity", self.identity, {0, kLastIdentity}, "",
                 "which face, skin and hair: the first eight are made by hand, the others drawn by their number");
    visit.number("height_m", self.height_m, {1.0, 2.1}, "m", "height");
    visit.list("outfit", self.outfit, "what can be worn; none: one of the identity's own");
    visit.list("head", self.head, "where the head looks");
    visit.list("presence", self.presence, "when the person is there, in which outfit");
    visit.section("walk", self.walk, "where the person goes");
    visit.flag("watches_robot", self.watches_robot,
               "turns to the robot that drives, wherever it is; headings then mean nothing");
    visit.number("makes_way_m", self.makes_way_m, {0.0, 5.0}, "m",
                 "steps aside where it would come nearer to the robot that drives; 0: walks through it");
  }
};

}  // namespace cgsr::sim
