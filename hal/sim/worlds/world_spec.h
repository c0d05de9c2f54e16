#pragma once

#include <string>
#include <vector>

#include "hal/sim/scene/camera_model.h"
#include "hal/sim/worlds/actor_spec.h"
#include "hal/sim/worlds/shape_spec.h"

namespace cgsr::sim {

/// A key of a light's script.
struct LightKeySpec {
  double at_s = 0.0;
  Triple factor{1.0, 1.0, 1.0};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("at_s", self.at_s, kTime_s, "s", "reached then; linear between keys");
    visit.numbers("factor", self.factor, {0.0, 1000.0}, "", "multiplies linear red, green and blue");
  }
};

/// [[lamp]]
struct LampSpec {
  int line = 0;
  std::string name = "lamp";
  Triple position_m{0.0, 0.0, 2.75};
  double radius_m = 0.0;
  Triple color{1.0, 0.93, 0.82};
  double lumens = 800.0;
  double bounce = 0.0;
  double globe_radius_m = 0.0;
  bool visible = true;
  bool on = true;
  std::string switch_name;
  std::string carried_by;
  std::vector<LightKeySpec> script;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.line(self.line);
    visit.text("name", self.name, "for messages and truth");
    visit.numbers("position_m", self.position_m, kAnywhere_m, "m", "centre; of a carried lamp in the robot's frame");
    visit.number("radius_m", self.radius_m, {0.0, 50.0}, "m", "0: a point with hard shadows; else a ball");
    visit.numbers("color", self.color, {0.0, 1.0}, "", "linear red, green and blue, the brightest carries the lumens");
    visit.number("lumens", self.lumens, {0.0, 1e9}, "lm", "light in all directions together");
    visit.number("bounce", self.bounce, {0.0, 1.0}, "1/m^2", "ambient lux per lumen that walls send back");
    visit.number("globe_radius_m", self.globe_radius_m, {0.0, 1.0}, "m",
                 "of the glass that is seen around a point; shadows stay hard; 0: none");
    visit.flag("visible", self.visible, "a ball or globe that is seen glowing");
    visit.flag("on", self.on, "when no switch is named");
    visit.text("switch", self.switch_name, "the line that switches it");
    visit.text("carried_by", self.carried_by, "the robot that it is mounted on");
    visit.list("script", self.script, "what it does over time");
  }
  [[nodiscard]] std::string inconsistency() const {
    return color[0] + color[1] + color[2] > 0.0 ? ""
                                                : "color: a lamp without any colour gives no light; use on = false";
  }
};

/// [ambient]
struct AmbientSpec {
  Triple illuminance_lux{60.0, 60.0, 60.0};
  double from_below = 0.6;
  double corner_reach_m = 0.8;
  std::vector<LightKeySpec> script;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.numbers("illuminance_lux", self.illuminance_lux, {0.0, 1e5}, "lx", "linear, on a free surface that looks up");
    visit.number("from_below", self.from_below, kShare, "", "the share of it that a surface looking down gets");
    visit.number("corner_reach_m", self.corner_reach_m, {0.0, 100.0}, "m",
                 "how far walls and furniture dim it; 0: not");
    visit.list("script", self.script, "what it does over time");
  }
};

/// [robot.board]
struct BoardSpec {
  Triple position_m{0.44, 0.0, 0.90};
  double width_m = 0.74;
  double depth_m = 0.34;
  double cone_height_m = 0.10;
  double cone_radius_m = 0.02;
  int cones = 2;
  double cone_aside_m = 0.20;
  double cone_forward_m = 0.01;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.numbers("position_m", self.position_m, {-3.0, 3.0}, "m", "middle of the upper face, robot frame");
    visit.number("width_m", self.width_m, {0.05, 3.0}, "m", "across");
    visit.number("depth_m", self.depth_m, {0.05, 3.0}, "m", "along");
    visit.number("cone_height_m", self.cone_height_m, {0.005, 1.0}, "m", "of a probe");
    visit.number("cone_radius_m", self.cone_radius_m, {0.001, 0.5}, "m", "of a probe's base");
    visit.number("cones", self.cones, {0, 2}, "", "one stands left only");
    visit.number("cone_aside_m", self.cone_aside_m, {0.0, 1.5}, "m", "from the middle of the board");
    visit.number("cone_forward_m", self.cone_forward_m, {-1.5, 1.5}, "m", "from the middle of the board");
  }
};

/// [robot.camera]: its lens, for 640 x 480 pixels; the words of CameraModel.
struct LensSpec {
  double fx_px = CameraModel{}.fx_px;
  double fy_px = CameraModel{}.fy_px;
  double cx_px = CameraModel{}.cx_px;
  double cy_px = CameraModel{}.cy_px;
  double k1 = CameraModel{}.k1;
  double k2 = CameraModel{}.k2;
  double p1 = CameraModel{}.p1;
  double p2 = CameraModel{}.p2;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("fx_px", self.fx_px, {100.0, 5000.0}, "px", "focal length across");
    visit.number("fy_px", self.fy_px, {100.0, 5000.0}, "px", "focal length down");
    visit.number("cx_px", self.cx_px, {0.0, 639.0}, "px", "column of the optical axis");
    visit.number("cy_px", self.cy_px, {0.0, 479.0}, "px", "row of the optical axis");
    visit.number("k1", self.k1, {-1.0, 1.0}, "", "radial distortion, of r^2");
    visit.number("k2", self.k2, {-1.0, 1.0}, "", "radial distortion, of r^4");
    visit.number("p1", self.p1, {-0.1, 0.1}, "", "tangential distortion");
    visit.number("p2", self.p2, {-0.1, 0.1}, "", "tangential distortion");
  }
};

/// [[robot]]: who looks. The first one's camera is the world's.
struct RobotSpec {
  int line = 0;
  std::string name = "robot";
  Triple start_m{0.0, 0.0, 0.0};
  double start_heading_deg = 0.0;
  double camera_height_m = 1.20;
  double camera_forward_m = 0.0;
  double camera_down_deg = 0.0;
  LensSpec camera;
  bool has_board = false;
  BoardSpec board;
  WalkSpec walk;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.line(self.line);
    visit.text("name", self.name, "for messages, truth and lamps that it carries");
    visit.numbers("start_m", self.start_m, kAnywhere_m, "m", "where it stands at first");
    visit.number("start_heading_deg", self.start_heading_deg, kAngle_deg, "deg", "where it looks at first");
    visit.number("camera_height_m", self.camera_height_m, {0.05, 5.0}, "m", "of the optical centre");
    visit.number("camera_forward_m", self.camera_forward_m, {-3.0, 3.0}, "m", "of the optical centre, before the axle");
    visit.number("camera_down_deg", self.camera_down_deg, {-80.0, 80.0}, "deg", "tilt below the horizon");
    visit.flag("has_board", self.has_board, "carries the probe board");
    visit.section("camera", self.camera, "its lens, for 640 x 480 pixels");
    visit.section("board", self.board, "the white board with its cones");
    visit.section("walk", self.walk, "a scripted way instead of a driven base: it starts there");
  }
};

/// [[view]]: a place to look from, for pictures of the world.
struct ViewSpec {
  std::string name = "view";
  Triple from_m{0.0, 0.0, 1.5};
  Triple to_m{1.0, 0.0, 1.5};
  double at_s = 0.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("name", self.name, "what `cgsr sim render` calls it");
    visit.numbers("from_m", self.from_m, kAnywhere_m, "m", "the camera");
    visit.numbers("to_m", self.to_m, kAnywhere_m, "m", "what is in the middle of the image");
    visit.number("at_s", self.at_s, kTime_s, "s", "when");
  }
  [[nodiscard]] std::string inconsistency() const {
    const bool apart = from_m[0] != to_m[0] || from_m[1] != to_m[1];
    return apart ? "" : "from_m and to_m may not lie above each other";
  }
};

/// [planar]: the world of many rectangles, generated for a number of edges (planar_world.h).
struct PlanarSpec {
  int edges = 0;
  bool half_behind = false;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("edges", self.edges, {0, 1000000}, "", "how many edges its map has; 0: none is generated");
    visit.flag("half_behind", self.half_behind, "as many again behind the camera, so that half of all are in view");
  }
};

/// A world file.
struct WorldSpec {
  std::string name;
  double exposure_s = 1.0 / 60.0;
  double gain = 1.0;
  std::vector<MaterialSpec> material;
  std::vector<ShapeSpec> shape;
  std::vector<LampSpec> lamp;
  AmbientSpec ambient;
  std::vector<BallSpec> ball;
  std::vector<ObjectSpec> object;
  std::vector<PersonSpec> person;
  std::vector<RobotSpec> robot;
  std::vector<ViewSpec> view;
  PlanarSpec planar;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("name", self.name, "for reports");
    visit.number("exposure_s", self.exposure_s, {1e-5, 1.0}, "s",
                 "that suits its light, for pictures and fixed exposure");
    visit.number("gain", self.gain, {0.1, 64.0}, "", "that suits its light");
    visit.section("ambient", self.ambient, "Light from everywhere");
    visit.section("planar", self.planar, "A generated world of rectangles");
    visit.list("material", self.material, "Surfaces");
    visit.list("shape", self.shape, "What stands still");
    visit.list("lamp", self.lamp, "Lamps");
    visit.list("ball", self.ball, "Balls");
    visit.list("object", self.object, "Things that move");
    visit.list("person", self.person, "People");
    visit.list("robot", self.robot, "Robots");
    visit.list("view", self.view, "Places to look from");
  }
};

}  // namespace cgsr::sim
