#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "hal/sim/scene/material.h"
#include "platform/parameters.h"

namespace cgsr::sim {

/// What a world file says: plain structs, one per kind of table. build_world() makes the scene out of them.
using Triple = std::array<double, 3>;

inline constexpr Range<double> kAnywhere_m{-1000.0, 1000.0};
inline constexpr Range<double> kShare{0.0, 1.0};
inline constexpr Range<double> kAngle_deg{-360.0, 360.0};
inline constexpr Range<double> kTime_s{0.0, 86400.0};

enum class ColorCode : std::uint8_t { kSrgb, kLinear };
inline constexpr Named<ColorCode> kColorCodeNames[] = {{"srgb", ColorCode::kSrgb}, {"linear", ColorCode::kLinear}};
constexpr std::string_view to_string(ColorCode code) {
  return word_in(kColorCodeNames, code);
}

/// [[material]]
struct MaterialSpec {
  int line = 0;
  std::string name;
  ColorCode code = ColorCode::kSrgb;
  Triple albedo{0.7, 0.7, 0.7};
  Triple second{0.2, 0.2, 0.2};
  PatternKind pattern = PatternKind::kPlain;
  double size_m = 0.1;
  double width = 0.5;
  double roughness = 1.0;
  double specular = 0.0;
  Triple glow_cd_m2{0.0, 0.0, 0.0};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.line(self.line);
    visit.text("name", self.name, "what shapes call it");
    visit.choice("code", self.code, kColorCodeNames, "how albedo and second are written");
    visit.numbers("albedo", self.albedo, kShare, "", "share of red, green and blue light that it sends back");
    visit.numbers("second", self.second, kShare, "", "the pattern's other colour");
    visit.choice("pattern", self.pattern, kPatternNames, "what is drawn on it");
    visit.number("size_m", self.size_m, {1e-4, 100.0}, "m", "square, period, spacing, letter, plank or blotch");
    visit.number("width", self.width, {1e-4, 10.0}, "", "stripes: share of the period; tape: width of a line in m");
    visit.number("roughness", self.roughness, {0.05, 1.0}, "", "of the gloss: 0.05 polished, 1 dull");
    visit.number("specular", self.specular, kShare, "", "gloss at normal incidence: 0 matt, 0.04 varnish");
    visit.numbers("glow_cd_m2", self.glow_cd_m2, {0.0, 1e5}, "cd/m^2", "shines by itself, lights nothing");
  }
  [[nodiscard]] std::string inconsistency() const {
    if (name.empty()) return "a material needs a name";
    if (pattern == PatternKind::kStripes && width > 1.0) return "width: stripes take up at most the whole period";
    if (pattern == PatternKind::kTape && width >= size_m) return "width: the lines are wider than their spacing size_m";
    return "";
  }
};

enum class ShapeKind : std::uint8_t {
  kBox,
  kRectangle,
  kDisc,
  kCylinder,
  kCone,
  kSphere,
  kMesh,
  kCheckerboard,
  kTable,
  kChair,
  kShelf,
  kCabinet,
  kSofa,
  kBed,
  kPlant,
  kPicture,
};

inline constexpr Named<ShapeKind> kShapeNames[] = {
    {"box", ShapeKind::kBox},     {"rectangle", ShapeKind::kRectangle},
    {"disc", ShapeKind::kDisc},   {"cylinder", ShapeKind::kCylinder},
    {"cone", ShapeKind::kCone},   {"sphere", ShapeKind::kSphere},
    {"mesh", ShapeKind::kMesh},   {"checkerboard", ShapeKind::kCheckerboard},
    {"table", ShapeKind::kTable}, {"chair", ShapeKind::kChair},
    {"shelf", ShapeKind::kShelf}, {"cabinet", ShapeKind::kCabinet},
    {"sofa", ShapeKind::kSofa},   {"bed", ShapeKind::kBed},
    {"plant", ShapeKind::kPlant}, {"picture", ShapeKind::kPicture},
};
constexpr std::string_view to_string(ShapeKind kind) {
  return word_in(kShapeNames, kind);
}

/// [[shape]]: everything that stands still (and, inside [[object]], what moves as one). `position_m` is the middle of its foot, `size_m`
/// the box around it before it is turned: x forward (where furniture faces), y left, z up.
struct ShapeSpec {
  int line = 0;
  std::string name;
  ShapeKind kind = ShapeKind::kBox;
  std::string material;
  std::string second_material;
  Triple position_m{0.0, 0.0, 0.0};
  Triple size_m{0.0, 0.0, 0.0};
  double heading_deg = 0.0;
  double lean_deg = 0.0;
  std::string file;
  double scale = 1.0;
  int columns = 9;
  int rows = 7;
  int count = 1;
  Triple step_m{0.0, 0.0, 0.0};
  bool casts_shadow = true;
  bool in_map = true;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.line(self.line);
    visit.text("name", self.name, "for messages and truth");
    visit.choice("kind", self.kind, kShapeNames, "primitive, mesh, checkerboard or a piece of furniture");
    visit.text("material", self.material, "its surface; a mesh keeps its own where this is empty");
    visit.text("second_material", self.second_material, "legs, frames, cushions, the other squares; empty: the same");
    visit.numbers("position_m", self.position_m, kAnywhere_m, "m", "middle of its foot");
    visit.numbers("size_m", self.size_m, {0.0, 1000.0}, "m",
                  "the box around it; of a rectangle one side is 0: z faces up, x along its heading");
    visit.number("heading_deg", self.heading_deg, kAngle_deg, "deg", "where its x axis points; 90 is the world's y");
    visit.number("lean_deg", self.lean_deg, kAngle_deg, "deg", "then tilted forward about its foot");
    visit.text("file", self.file, "of a mesh (OBJ with MTL, glTF), beside this file");
    visit.number("scale", self.scale, {1e-4, 1e4}, "", "of a mesh: metres per unit of its file");
    visit.number("columns", self.columns, {1, 100}, "", "squares of a checkerboard across");
    visit.number("rows", self.rows, {1, 100}, "", "squares of a checkerboard down");
    visit.number("count", self.count, {1, 10000}, "", "so many in a row");
    visit.numbers("step_m", self.step_m, kAnywhere_m, "m", "from one to the next");
    visit.flag("casts_shadow", self.casts_shadow, "false for tape, paint and paper lying on something");
    visit.flag("in_map", self.in_map, "false for what the robot's map does not hold");
  }
  [[nodiscard]] std::string inconsistency() const;
};

}  // namespace cgsr::sim
