#include "hal/sim/generator/makes.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "hal/sim/generator/make_parts.h"

namespace cgsr::sim {
namespace {

/// Four legs under the corners; details that a map leaves out when they are thin.
void add_legs(Make& make, const std::string& material, double height, double thick, double inset, bool in_map) {
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      make.shapes.push_back(make_box_part(
          "leg", material,
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
    make.shapes.push_back(make_box_part("front", material, {make.size_m[0] / 2 - 0.009, y, i * high + 0.008},
                                        {0.018, width - 0.01, high - 0.016}));
    make.shapes.push_back(
        make_box_part("bar", bar, {make.size_m[0] / 2 + 0.008, y, i * high + 0.7 * high}, {0.016, 0.12, 0.014}));
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
  make.shapes = {make_cylinder_part("top", wood, {0, 0, height - 0.03}, diameter, 0.03),
                 make_cylinder_part("column", metal, {0, 0, 0.03}, 0.07, height - 0.06),
                 make_cylinder_part("foot", metal, {0, 0, 0}, 0.55 * diameter, 0.03)};
  for (std::size_t i = 1; i < make.shapes.size(); ++i) make.shapes[i].in_map = false;  // round and thin
  return make;
}

Make trestle_table(Palette& palette, const char* name, const Triple& size) {
  Make make{name, size, {}, true, false};
  const std::string top = palette.wood();
  const std::string side = palette.wood();
  make.shapes = {make_box_part("top", top, {0, 0, size[2] - 0.04}, {size[0], size[1], 0.04}),
                 make_box_part("side", side, {0, 0.42 * size[1], 0}, {0.8 * size[0], 0.04, size[2] - 0.04}),
                 make_box_part("side", side, {0, -0.42 * size[1], 0}, {0.8 * size[0], 0.04, size[2] - 0.04}),
                 make_box_part("rail", side, {0, 0, 0.3 * size[2]}, {0.03, 0.84 * size[1] - 0.04, 0.10})};
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
      make_known(ShapeKind::kTable, "table", {depth, width, height}, top, draw.chance(0.5) ? top : palette.metal()));
}

Make make_low_table(Palette& palette, Draw& draw) {
  const double height = draw.uniform(0.35, 0.46);
  if (draw.chance(0.35)) return round_table(palette, "round low table", draw.uniform(0.5, 0.85), height);
  const double depth = draw.uniform(0.45, 0.6);
  const double width = draw.uniform(0.7, 1.1);
  const std::string top = palette.wood();
  return topped(make_known(ShapeKind::kTable, "low table", {depth, width, height}, top, palette.metal()));
}

Make make_desk(Palette& palette, Draw& draw) {
  const double width = draw.uniform(1.1, 1.6);
  Make make{"desk", {draw.uniform(0.55, 0.7), width, draw.uniform(0.72, 0.76)}, {}, true, false};
  const std::string top = palette.wood();
  const std::string body = palette.wood();
  const double depth = make.size_m[0];
  const double under = make.size_m[2] - 0.03;
  make.shapes = {make_box_part("top", top, {0, 0, under}, {depth, width, 0.03}),
                 make_box_part("side", body, {0, width / 2 - 0.03, 0}, {0.9 * depth, 0.03, under}),
                 make_box_part("block", body, {-0.02, -width / 2 + 0.22, 0}, {0.9 * depth, 0.40, under}),
                 make_box_part("back", body, {-0.35 * depth, 0.18, 0.35}, {0.02, width - 0.5, 0.3})};
  return topped(std::move(make));
}

Make make_chair(Palette& palette, Draw& draw) {
  const double side = draw.uniform(0.40, 0.47);
  const double height = draw.uniform(0.82, 0.95);
  const std::string seat = draw.chance(0.6) ? palette.wood() : palette.paint();
  return make_known(ShapeKind::kChair, "chair", {side, side, height}, seat, palette.metal());
}

Make make_stool(Palette& palette, Draw& draw) {
  const double diameter = draw.uniform(0.30, 0.38);
  Make make{"stool", {diameter, diameter, draw.uniform(0.44, 0.66)}, {}, true, false};
  const std::string seat = palette.wood();
  const std::string metal = palette.metal();
  make.shapes = {make_cylinder_part("seat", seat, {0, 0, make.size_m[2] - 0.04}, diameter, 0.04)};
  add_legs(make, metal, make.size_m[2] - 0.04, 0.025, 0.04, false);
  return make;
}

Make make_shelf(Palette& palette, Draw& draw) {
  const double depth = draw.uniform(0.25, 0.38);
  const double width = draw.uniform(0.6, 1.4);
  const double height = draw.uniform(0.9, 2.1);
  if (draw.chance(0.6)) {
    const std::string wood = draw.chance(0.4) ? palette.white() : palette.wood();
    return topped(make_known(ShapeKind::kShelf, "shelf", {depth, width, height}, wood, palette.books()));
  }
  Make make{"rack", {depth, width, height}, {}, true, false};
  const std::string board = palette.wood();
  const std::string metal = palette.metal();
  const int boards = std::max(3, static_cast<int>(height / 0.42));
  for (int i = 0; i < boards; ++i) {
    const double z = 0.1 + i * (height - 0.13) / (boards - 1);
    make.shapes.push_back(make_box_part("board", board, {0, 0, z}, {depth - 0.02, width - 0.02, 0.03}));
    if (i + 1 == boards || draw.chance(0.35)) continue;
    const double wide = draw.uniform(0.25, 0.7) * width;
    const double aside = draw.uniform(-0.5, 0.5) * (width - 0.04 - wide);
    const double high = draw.uniform(0.12, 0.28);
    make.shapes.push_back(make_box_part("load", draw.chance(0.5) ? palette.books() : palette.paint(),
                                        {0, aside, z + 0.03}, {0.7 * depth, wide, high}));
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
  return topped(make_known(ShapeKind::kCabinet, "sideboard", {depth, width, height}, wood, palette.metal()));
}

Make make_wardrobe(Palette& palette, Draw& draw) {
  const double width = draw.uniform(0.9, 2.0);
  const double height = draw.uniform(1.8, 2.2);
  const std::string wood = draw.chance(0.5) ? palette.white() : palette.wood();
  return make_known(ShapeKind::kCabinet, "wardrobe", {draw.uniform(0.52, 0.62), width, height}, wood, palette.metal());
}

Make make_drawers(Palette& palette, Draw& draw) {
  const double width = draw.uniform(0.5, 1.1);
  Make make{"drawers", {draw.uniform(0.40, 0.5), width, draw.uniform(0.7, 1.25)}, {}, true, false};
  const std::string body = palette.wood();
  const std::string front = draw.chance(0.6) ? body : palette.white();
  make.shapes = {make_box_part("body", body, {-0.009, 0, 0}, {make.size_m[0] - 0.018, width, make.size_m[2]})};
  add_drawer_fronts(make, front, palette.metal(), draw.between(3, 5), 0.0, width);
  return topped(std::move(make));
}

Make make_sofa(Palette& palette, Draw& draw) {
  const double width = draw.uniform(1.5, 2.3);
  const double height = draw.uniform(0.72, 0.88);
  const double depth = draw.uniform(0.8, 0.95);
  const std::string cloth = palette.cloth();
  return make_known(ShapeKind::kSofa, "sofa", {depth, width, height}, cloth,
                    draw.chance(0.5) ? cloth : palette.cloth());
}

Make make_armchair(Palette& palette, Draw& draw) {
  const double width = draw.uniform(0.8, 0.98);
  const double depth = draw.uniform(0.75, 0.85);
  const double height = draw.uniform(0.75, 0.9);
  const std::string cloth = palette.cloth();
  return make_known(ShapeKind::kSofa, "armchair", {depth, width, height}, cloth,
                    draw.chance(0.5) ? cloth : palette.cloth());
}

Make make_bench(Palette& palette, Draw& draw) {
  const double width = draw.uniform(0.9, 1.4);
  Make make{"bench", {draw.uniform(0.34, 0.44), width, draw.uniform(0.42, 0.5)}, {}, true, false};
  const std::string seat = palette.wood();
  make.shapes = {make_box_part("seat", seat, {0, 0, make.size_m[2] - 0.04}, {make.size_m[0], width, 0.04})};
  add_legs(make, seat, make.size_m[2] - 0.04, 0.05, 0.03, true);
  return make;
}

Make make_ottoman(Palette& palette, Draw& draw) {
  const double diameter = draw.uniform(0.4, 0.65);
  Make make{"ottoman", {diameter, diameter, draw.uniform(0.35, 0.45)}, {}, true, false};
  make.shapes = {make_cylinder_part("", palette.cloth(), {0, 0, 0}, diameter, make.size_m[2])};
  return make;
}

Make make_bed(Palette& palette, Draw& draw) {
  const double width = draw.chance(0.5) ? draw.uniform(0.9, 1.0) : draw.uniform(1.4, 1.8);
  const double length = draw.uniform(1.95, 2.1);
  const std::string wood = palette.wood();
  const std::string cloth = palette.cloth();
  if (draw.chance(0.65)) {
    Make make = make_known(ShapeKind::kBed, "bed", {length, width, draw.uniform(0.55, 0.7)}, wood, cloth);
    make.size_m[0] += 0.08;  // its head
    make.shapes[0].position_m[0] = 0.04;
    return make;
  }
  Make make{"futon", {length, width, 0.4}, {}, true, false};
  make.shapes = {make_box_part("base", wood, {0, 0, 0}, {length, width, 0.2}),
                 make_box_part("mattress", cloth, {0, 0, 0.2}, {length - 0.1, width - 0.1, 0.16}),
                 make_box_part("pillow", palette.white(), {-length / 2 + 0.3, 0, 0.36}, {0.4, 0.7 * width, 0.1})};
  make.shapes.back().in_map = false;
  return make;
}

Make make_night_table(Palette& palette, Draw& draw) {
  const double width = draw.uniform(0.38, 0.5);
  const double height = draw.uniform(0.45, 0.6);
  Make make{"night table", {0.4, width, height}, {}, true, false};
  const std::string body = palette.wood();
  make.shapes = {make_box_part("body", body, {-0.009, 0, 0}, {0.382, width, height})};
  add_drawer_fronts(make, body, palette.metal(), 2, 0.0, width);
  return topped(std::move(make));
}

Make make_television(Palette& palette, Draw& draw) {
  const double width = draw.uniform(1.1, 1.9);
  const double height = draw.uniform(0.42, 0.72);
  const std::string wood = palette.wood();
  Make make = make_known(ShapeKind::kCabinet, "television", {0.42, width, height}, wood, palette.metal());
  make.shapes[0].name = "stand";
  const double screen = draw.uniform(0.75, std::min(1.3, width - 0.1));
  make.shapes.push_back(make_box_part("foot", palette.metal(), {-0.05, 0, height}, {0.18, 0.35, 0.06}));
  make.shapes.back().in_map = false;
  make.shapes.push_back(
      make_box_part("screen", palette.screen(), {-0.05, 0, height + 0.06}, {0.05, screen, 0.57 * screen}));
  make.size_m[2] = height + 0.06 + 0.57 * screen;
  return make;
}

}  // namespace cgsr::sim
