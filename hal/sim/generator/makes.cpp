#include "hal/sim/generator/makes.h"

#include <algorithm>
#include <utility>

namespace cgsr::sim {
namespace {

ShapeSpec shape(ShapeKind kind, std::string part, std::string material, const Triple& foot, const Triple& size) {
  ShapeSpec spec;
  spec.kind = kind;
  spec.name = std::move(part);
  spec.material = std::move(material);
  spec.position_m = {rounded(foot[0]), rounded(foot[1]), rounded(foot[2])};
  spec.size_m = {rounded(size[0]), rounded(size[1]), rounded(size[2])};
  return spec;
}

ShapeSpec box(std::string part, std::string material, const Triple& foot, const Triple& size) {
  return shape(ShapeKind::kBox, std::move(part), std::move(material), foot, size);
}

ShapeSpec cylinder(std::string part, std::string material, const Triple& foot, double diameter, double height) {
  return shape(ShapeKind::kCylinder, std::move(part), std::move(material), foot, {diameter, diameter, height});
}

/// One that world files know as a whole.
Make known(ShapeKind kind, std::string name, const Triple& size, std::string material, std::string second) {
  Make make{std::move(name), size, {}, true, false};
  make.shapes.push_back(shape(kind, "", std::move(material), {0, 0, 0}, size));
  make.shapes.back().second_material = std::move(second);
  return make;
}

/// Four legs under the corners; details that a map leaves out when they are thin.
void add_legs(Make& make, const std::string& material, double height, double thick, double inset, bool in_map) {
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      make.shapes.push_back(
          box("leg", material,
              {sx * (make.size_m[0] / 2 - inset - thick / 2), sy * (make.size_m[1] / 2 - inset - thick / 2), 0.0},
              {thick, thick, height}));
      make.shapes.back().in_map = in_map;
    }
  }
}

/// Fronts of drawers, one above the other, with a bar each.
void add_drawer_fronts(Make& make, const std::string& material, const std::string& bar, int drawers, double y,
                       double width) {
  const double high = make.size_m[2] / drawers;
  for (int i = 0; i < drawers; ++i) {
    make.shapes.push_back(
        box("front", material, {make.size_m[0] / 2 - 0.009, y, i * high + 0.008}, {0.018, width - 0.01, high - 0.016}));
    make.shapes.push_back(
        box("bar", bar, {make.size_m[0] / 2 + 0.008, y, i * high + 0.7 * high}, {0.016, 0.12, 0.014}));
    make.shapes.back().in_map = false;
  }
}

/// Small things can stand on it.
Make topped(Make make) {
  make.flat_top = true;
  return make;
}

Make round_table(Palette& palette, const char* name, double diameter, double height) {
  Make make{name, {diameter, diameter, height}, {}, true, false};
  const std::string wood = palette.wood();
  const std::string metal = palette.metal();
  make.shapes = {cylinder("top", wood, {0, 0, height - 0.03}, diameter, 0.03),
                 cylinder("column", metal, {0, 0, 0.03}, 0.07, height - 0.06),
                 cylinder("foot", metal, {0, 0, 0}, 0.55 * diameter, 0.03)};
  return make;
}

Make trestle_table(Palette& palette, const char* name, const Triple& size) {
  Make make{name, size, {}, true, false};
  const std::string top = palette.wood();
  const std::string side = palette.wood();
  make.shapes = {box("top", top, {0, 0, size[2] - 0.04}, {size[0], size[1], 0.04}),
                 box("side", side, {0, 0.42 * size[1], 0}, {0.8 * size[0], 0.04, size[2] - 0.04}),
                 box("side", side, {0, -0.42 * size[1], 0}, {0.8 * size[0], 0.04, size[2] - 0.04}),
                 box("rail", side, {0, 0, 0.3 * size[2]}, {0.03, 0.84 * size[1] - 0.04, 0.10})};
  return make;
}

}  // namespace

Make make_dining_table(Palette& palette, Draw& draw) {
  const double depth = draw.uniform(0.7, 0.95);
  const double width = draw.uniform(1.1, 1.8);
  const double height = draw.uniform(0.72, 0.77);
  const int make = draw.below(3);
  if (make == 0) return round_table(palette, "round table", draw.uniform(0.8, 1.2), height);
  if (make == 1) return topped(trestle_table(palette, "trestle table", {depth, width, height}));
  const std::string top = palette.wood();
  return topped(
      known(ShapeKind::kTable, "table", {depth, width, height}, top, draw.chance(0.5) ? top : palette.metal()));
}

Make make_low_table(Palette& palette, Draw& draw) {
  const double height = draw.uniform(0.35, 0.46);
  if (draw.chance(0.35)) return round_table(palette, "round low table", draw.uniform(0.5, 0.85), height);
  const double depth = draw.uniform(0.45, 0.6);
  const double width = draw.uniform(0.7, 1.1);
  const std::string top = palette.wood();
  return topped(known(ShapeKind::kTable, "low table", {depth, width, height}, top, palette.metal()));
}

Make make_desk(Palette& palette, Draw& draw) {
  const double width = draw.uniform(1.1, 1.6);
  Make make{"desk", {draw.uniform(0.55, 0.7), width, draw.uniform(0.72, 0.76)}, {}, true, false};
  const std::string top = palette.wood();
  const std::string body = palette.wood();
  const double depth = make.size_m[0];
  const double under = make.size_m[2] - 0.03;
  make.shapes = {box("top", top, {0, 0, under}, {depth, width, 0.03}),
                 box("side", body, {0, width / 2 - 0.03, 0}, {0.9 * depth, 0.03, under}),
                 box("block", body, {-0.02, -width / 2 + 0.22, 0}, {0.9 * depth, 0.40, under}),
                 box("back", body, {-0.35 * depth, 0.18, 0.35}, {0.02, width - 0.5, 0.3})};
  return topped(std::move(make));
}

Make make_chair(Palette& palette, Draw& draw) {
  const double side = draw.uniform(0.40, 0.47);
  const double height = draw.uniform(0.82, 0.95);
  const std::string seat = draw.chance(0.6) ? palette.wood() : palette.paint();
  return known(ShapeKind::kChair, "chair", {side, side, height}, seat, palette.metal());
}

Make make_stool(Palette& palette, Draw& draw) {
  const double diameter = draw.uniform(0.30, 0.38);
  Make make{"stool", {diameter, diameter, draw.uniform(0.44, 0.66)}, {}, true, false};
  const std::string seat = palette.wood();
  const std::string metal = palette.metal();
  make.shapes = {cylinder("seat", seat, {0, 0, make.size_m[2] - 0.04}, diameter, 0.04)};
  add_legs(make, metal, make.size_m[2] - 0.04, 0.025, 0.04, false);
  return make;
}

Make make_shelf(Palette& palette, Draw& draw) {
  const double depth = draw.uniform(0.25, 0.38);
  const double width = draw.uniform(0.6, 1.4);
  const double height = draw.uniform(0.9, 2.1);
  if (draw.chance(0.6)) {
    const std::string wood = draw.chance(0.4) ? palette.white() : palette.wood();
    return topped(known(ShapeKind::kShelf, "shelf", {depth, width, height}, wood, palette.books()));
  }
  Make make{"rack", {depth, width, height}, {}, true, false};
  const std::string board = palette.wood();
  const std::string metal = palette.metal();
  const int boards = std::max(3, static_cast<int>(height / 0.42));
  for (int i = 0; i < boards; ++i) {
    const double z = 0.1 + i * (height - 0.13) / (boards - 1);
    make.shapes.push_back(box("board", board, {0, 0, z}, {depth - 0.02, width - 0.02, 0.03}));
    if (i + 1 == boards || draw.chance(0.35)) continue;
    const double wide = draw.uniform(0.25, 0.7) * width;
    const double aside = draw.uniform(-0.5, 0.5) * (width - 0.04 - wide);
    const double high = draw.uniform(0.12, 0.28);
    make.shapes.push_back(box("load", draw.chance(0.5) ? palette.books() : palette.paint(), {0, aside, z + 0.03},
                              {0.7 * depth, wide, high}));
    make.shapes.back().in_map = false;
  }
  add_legs(make, metal, height, 0.03, 0.0, true);
  return make;
}

Make make_sideboard(Palette& palette, Draw& draw) {
  const double depth = draw.uniform(0.38, 0.48);
  const double width = draw.uniform(0.9, 1.9);
  const double height = draw.uniform(0.6, 0.95);
  const std::string wood = palette.wood();
  return topped(known(ShapeKind::kCabinet, "sideboard", {depth, width, height}, wood, palette.metal()));
}

Make make_wardrobe(Palette& palette, Draw& draw) {
  const double width = draw.uniform(0.9, 2.0);
  const double height = draw.uniform(1.8, 2.2);
  const std::string wood = draw.chance(0.5) ? palette.white() : palette.wood();
  return known(ShapeKind::kCabinet, "wardrobe", {draw.uniform(0.52, 0.62), width, height}, wood, palette.metal());
}

Make make_drawers(Palette& palette, Draw& draw) {
  const double width = draw.uniform(0.5, 1.1);
  Make make{"drawers", {draw.uniform(0.40, 0.5), width, draw.uniform(0.7, 1.25)}, {}, true, false};
  const std::string body = palette.wood();
  const std::string front = draw.chance(0.6) ? body : palette.white();
  make.shapes = {box("body", body, {-0.009, 0, 0}, {make.size_m[0] - 0.018, width, make.size_m[2]})};
  add_drawer_fronts(make, front, palette.metal(), draw.between(3, 5), 0.0, width);
  return topped(std::move(make));
}

Make make_sofa(Palette& palette, Draw& draw) {
  const double width = draw.uniform(1.5, 2.3);
  const double height = draw.uniform(0.72, 0.88);
  const double depth = draw.uniform(0.8, 0.95);
  const std::string cloth = palette.cloth();
  return known(ShapeKind::kSofa, "sofa", {depth, width, height}, cloth, draw.chance(0.5) ? cloth : palette.cloth());
}

Make make_armchair(Palette& palette, Draw& draw) {
  const double width = draw.uniform(0.8, 0.98);
  const double depth = draw.uniform(0.75, 0.85);
  const double height = draw.uniform(0.75, 0.9);
  const std::string cloth = palette.cloth();
  return known(ShapeKind::kSofa, "armchair", {depth, width, height}, cloth, draw.chance(0.5) ? cloth : palette.cloth());
}

Make make_bench(Palette& palette, Draw& draw) {
  const double width = draw.uniform(0.9, 1.4);
  Make make{"bench", {draw.uniform(0.34, 0.44), width, draw.uniform(0.42, 0.5)}, {}, true, false};
  const std::string seat = palette.wood();
  make.shapes = {box("seat", seat, {0, 0, make.size_m[2] - 0.04}, {make.size_m[0], width, 0.04})};
  add_legs(make, seat, make.size_m[2] - 0.04, 0.05, 0.03, true);
  return make;
}

Make make_ottoman(Palette& palette, Draw& draw) {
  const double diameter = draw.uniform(0.4, 0.65);
  Make make{"ottoman", {diameter, diameter, draw.uniform(0.35, 0.45)}, {}, true, false};
  make.shapes = {cylinder("", palette.cloth(), {0, 0, 0}, diameter, make.size_m[2])};
  return make;
}

Make make_bed(Palette& palette, Draw& draw) {
  const double width = draw.chance(0.5) ? draw.uniform(0.9, 1.0) : draw.uniform(1.4, 1.8);
  const double length = draw.uniform(1.95, 2.1);
  const std::string wood = palette.wood();
  const std::string cloth = palette.cloth();
  if (draw.chance(0.65)) {
    Make make = known(ShapeKind::kBed, "bed", {length, width, draw.uniform(0.55, 0.7)}, wood, cloth);
    make.size_m[0] += 0.08;  // its head
    make.shapes[0].position_m[0] = 0.04;
    return make;
  }
  Make make{"futon", {length, width, 0.4}, {}, true, false};
  make.shapes = {box("base", wood, {0, 0, 0}, {length, width, 0.2}),
                 box("mattress", cloth, {0, 0, 0.2}, {length - 0.1, width - 0.1, 0.16}),
                 box("pillow", palette.white(), {-length / 2 + 0.3, 0, 0.36}, {0.4, 0.7 * width, 0.1})};
  make.shapes.back().in_map = false;
  return make;
}

Make make_night_table(Palette& palette, Draw& draw) {
  const double width = draw.uniform(0.38, 0.5);
  const double height = draw.uniform(0.45, 0.6);
  Make make{"night table", {0.4, width, height}, {}, true, false};
  const std::string body = palette.wood();
  make.shapes = {box("body", body, {-0.009, 0, 0}, {0.382, width, height})};
  add_drawer_fronts(make, body, palette.metal(), 2, 0.0, width);
  return topped(std::move(make));
}

Make make_television(Palette& palette, Draw& draw) {
  const double width = draw.uniform(1.1, 1.9);
  const double height = draw.uniform(0.42, 0.72);
  const std::string wood = palette.wood();
  Make make = known(ShapeKind::kCabinet, "television", {0.42, width, height}, wood, palette.metal());
  make.shapes[0].name = "stand";
  const double screen = draw.uniform(0.75, std::min(1.3, width - 0.1));
  make.shapes.push_back(box("foot", palette.metal(), {-0.05, 0, height}, {0.18, 0.35, 0.06}));
  make.shapes.back().in_map = false;
  make.shapes.push_back(box("screen", palette.screen(), {-0.05, 0, height + 0.06}, {0.05, screen, 0.57 * screen}));
  make.size_m[2] = height + 0.06 + 0.57 * screen;
  return make;
}

Make make_kitchen_row(Palette& palette, Draw& draw, double width_m) {
  Make make{"kitchen row", {0.62, width_m, 2.2}, {}, true, false};
  const std::string body = draw.chance(0.6) ? palette.white() : palette.wood();
  const std::string handle = palette.metal();
  const double height = draw.uniform(0.84, 0.9);
  make.shapes = {shape(ShapeKind::kCabinet, "counter", body, {-0.02, 0, 0}, {0.58, width_m, height}),
                 box("worktop", palette.wood(), {0, 0, height}, {0.62, width_m, 0.04}),
                 box("stove", palette.screen(), {0, 0.25 * width_m, height + 0.04}, {0.5, 0.56, 0.008})};
  make.shapes[0].second_material = handle;
  if (draw.chance(0.75)) {
    const double foot = draw.uniform(1.4, 1.5);
    const double high = draw.uniform(0.55, 0.7);
    make.shapes.push_back(shape(ShapeKind::kCabinet, "wall units", body, {-0.14, 0, foot}, {0.34, width_m, high}));
    make.shapes.back().second_material = handle;
  }
  return make;
}

Make make_fridge(Palette& palette, Draw& draw) {
  const double height = draw.uniform(1.4, 1.95);
  const std::string body = draw.chance(0.5) ? palette.white() : palette.metal();
  return known(ShapeKind::kCabinet, "fridge", {0.62, draw.uniform(0.56, 0.64), height}, body, palette.metal());
}

Make make_tub(Palette& palette, Draw& draw) {
  const double width = draw.uniform(1.5, 1.75);
  Make make{"tub", {draw.uniform(0.68, 0.78), width, draw.uniform(0.52, 0.6)}, {}, true, false};
  const std::string white = palette.white();
  const double d = make.size_m[0];
  const double h = make.size_m[2];
  make.shapes = {box("front", white, {d / 2 - 0.03, 0, 0}, {0.06, width, h}),
                 box("rear", white, {-d / 2 + 0.03, 0, 0}, {0.06, width, h}),
                 box("end", white, {0, width / 2 - 0.03, 0}, {d - 0.12, 0.06, h}),
                 box("end", white, {0, -width / 2 + 0.03, 0}, {d - 0.12, 0.06, h}),
                 box("bottom", white, {0, 0, 0}, {d - 0.12, width - 0.12, 0.14})};
  return make;
}

Make make_washstand(Palette& palette, Draw& draw) {
  const double width = draw.uniform(0.6, 1.0);
  const std::string body = draw.chance(0.5) ? palette.white() : palette.wood();
  Make make = known(ShapeKind::kCabinet, "washstand", {0.46, width, draw.uniform(0.72, 0.8)}, body, palette.metal());
  make.shapes[0].name = "body";
  make.shapes.push_back(box("basin", palette.white(), {0, 0, make.size_m[2]}, {0.44, width - 0.04, 0.09}));
  make.size_m[2] += 0.09;
  return make;
}

Make make_plant(Palette& palette, Draw& draw) {
  const double side = draw.uniform(0.4, 0.65);
  const std::string leaf = palette.leaf();
  Make make = known(ShapeKind::kPlant, "plant", {side, side, draw.uniform(0.6, 1.4)}, leaf, palette.pot());
  make.in_map = false;
  return make;
}

Make make_clutter(Palette& palette, Draw& draw) {
  const int kind = draw.below(4);
  Make make;
  make.in_map = false;
  if (kind == 0) {
    make = {"carton", {draw.uniform(0.2, 0.45), draw.uniform(0.2, 0.5), draw.uniform(0.15, 0.45)}, {}, false, false};
    make.shapes = {box("", draw.chance(0.5) ? palette.wood() : palette.paint(), {0, 0, 0}, make.size_m)};
  } else if (kind == 1) {
    const double diameter = draw.uniform(0.2, 0.34);
    make = {"bin", {diameter, diameter, draw.uniform(0.28, 0.5)}, {}, false, false};
    make.shapes = {
        cylinder("", draw.chance(0.5) ? palette.metal() : palette.paint(), {0, 0, 0}, diameter, make.size_m[2])};
  } else if (kind == 2) {
    const double diameter = draw.uniform(0.14, 0.3);
    make = {"toy ball", {diameter, diameter, diameter}, {}, false, false};
    make.shapes = {shape(ShapeKind::kSphere, "", palette.paint(), {0, 0, 0}, make.size_m)};
  } else {
    make = {"bag", {draw.uniform(0.12, 0.2), draw.uniform(0.3, 0.5), draw.uniform(0.28, 0.42)}, {}, false, false};
    const std::string cloth = palette.cloth();
    make.shapes = {box("body", cloth, {0, 0, 0}, make.size_m),
                   box("strap", cloth, {0, 0, make.size_m[2]}, {0.02, 0.6 * make.size_m[1], 0.06})};
  }
  return make;
}

Make make_small_thing(Palette& palette, Draw& draw) {
  Make make;
  if (draw.chance(0.45)) {
    const double diameter = draw.uniform(0.07, 0.16);
    make = {"vase", {diameter, diameter, draw.uniform(0.10, 0.32)}, {}, false, false};
    make.shapes = {
        cylinder("", draw.chance(0.5) ? palette.paint() : palette.pot(), {0, 0, 0}, diameter, make.size_m[2])};
  } else {
    make = {"box", {draw.uniform(0.1, 0.24), draw.uniform(0.12, 0.3), draw.uniform(0.04, 0.24)}, {}, false, false};
    make.shapes = {box("", draw.chance(0.5) ? palette.paint() : palette.books(), {0, 0, 0}, make.size_m)};
  }
  return make;
}

}  // namespace cgsr::sim
