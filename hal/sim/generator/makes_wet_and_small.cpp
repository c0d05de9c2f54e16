// Kitchen, bath, plants and clutter.
#include <utility>

#include "hal/sim/generator/make_parts.h"
#include "hal/sim/generator/makes.h"

namespace cgsr::sim {

Make make_kitchen_row(Palette& palette, Draw& draw, double width_m) {
  Make make{"kitchen row", {0.62, width_m, 2.2}, {}, true, false};
  const std::string body = draw.chance(0.6) ? palette.white() : palette.wood();
  const std::string handle = palette.metal();
  const double height = draw.uniform(0.84, 0.9);
  make.shapes = {make_part(ShapeKind::kCabinet, "counter", body, {-0.02, 0, 0}, {0.58, width_m, height}),
                 make_box_part("worktop", palette.wood(), {0, 0, height}, {0.62, width_m, 0.04}),
                 make_box_part("stove", palette.screen(), {0, 0.25 * width_m, height + 0.04}, {0.5, 0.56, 0.008})};
  make.shapes[0].second_material = handle;
  if (draw.chance(0.75)) {
    const double foot = draw.uniform(1.4, 1.5);
    const double high = draw.uniform(0.55, 0.7);
    make.shapes.push_back(make_part(ShapeKind::kCabinet, "wall units", body, {-0.14, 0, foot}, {0.34, width_m, high}));
    make.shapes.back().second_material = handle;
  }
  return make;
}

Make make_fridge(Palette& palette, Draw& draw) {
  const double height = draw.uniform(1.4, 1.95);
  const std::string body = draw.chance(0.5) ? palette.white() : palette.metal();
  return make_known(ShapeKind::kCabinet, "fridge", {0.62, draw.uniform(0.56, 0.64), height}, body, palette.metal());
}

Make make_tub(Palette& palette, Draw& draw) {
  const double width = draw.uniform(1.5, 1.75);
  Make make{"tub", {draw.uniform(0.68, 0.78), width, draw.uniform(0.52, 0.6)}, {}, true, false};
  const std::string white = palette.white();
  const double d = make.size_m[0];
  const double h = make.size_m[2];
  make.shapes = {make_box_part("front", white, {d / 2 - 0.03, 0, 0}, {0.06, width, h}),
                 make_box_part("rear", white, {-d / 2 + 0.03, 0, 0}, {0.06, width, h}),
                 make_box_part("end", white, {0, width / 2 - 0.03, 0}, {d - 0.12, 0.06, h}),
                 make_box_part("end", white, {0, -width / 2 + 0.03, 0}, {d - 0.12, 0.06, h}),
                 make_box_part("bottom", white, {0, 0, 0}, {d - 0.12, width - 0.12, 0.14})};
  return make;
}

Make make_washstand(Palette& palette, Draw& draw) {
  const double width = draw.uniform(0.6, 1.0);
  const std::string body = draw.chance(0.5) ? palette.white() : palette.wood();
  Make make =
      make_known(ShapeKind::kCabinet, "washstand", {0.46, width, draw.uniform(0.72, 0.8)}, body, palette.metal());
  make.shapes[0].name = "body";
  make.shapes.push_back(make_box_part("basin", palette.white(), {0, 0, make.size_m[2]}, {0.44, width - 0.04, 0.09}));
  make.size_m[2] += 0.09;
  return make;
}

Make make_plant(Palette& palette, Draw& draw) {
  const double side = draw.uniform(0.4, 0.65);
  const std::string leaf = palette.leaf();
  Make make = make_known(ShapeKind::kPlant, "plant", {side, side, draw.uniform(0.6, 1.4)}, leaf, palette.pot());
  make.in_map = false;
  return make;
}

Make make_clutter(Palette& palette, Draw& draw) {
  const int kind = draw.below(4);
  Make make;
  make.in_map = false;
  if (kind == 0) {
    make = {"carton", {draw.uniform(0.2, 0.45), draw.uniform(0.2, 0.5), draw.uniform(0.15, 0.45)}, {}, false, false};
    make.shapes = {make_box_part("", draw.chance(0.5) ? palette.wood() : palette.paint(), {0, 0, 0}, make.size_m)};
  } else if (kind == 1) {
    const double diameter = draw.uniform(0.2, 0.34);
    make = {"bin", {diameter, diameter, draw.uniform(0.28, 0.5)}, {}, false, false};
    make.shapes = {make_cylinder_part("", draw.chance(0.5) ? palette.metal() : palette.paint(), {0, 0, 0}, diameter,
                                      make.size_m[2])};
  } else if (kind == 2) {
    const double diameter = draw.uniform(0.14, 0.3);
    make = {"toy ball", {diameter, diameter, diameter}, {}, false, false};
    make.shapes = {make_part(ShapeKind::kSphere, "", palette.paint(), {0, 0, 0}, make.size_m)};
  } else {
    make = {"bag", {draw.uniform(0.12, 0.2), draw.uniform(0.3, 0.5), draw.uniform(0.28, 0.42)}, {}, false, false};
    const std::string cloth = palette.cloth();
    make.shapes = {make_box_part("body", cloth, {0, 0, 0}, make.size_m),
                   make_box_part("strap", cloth, {0, 0, make.size_m[2]}, {0.02, 0.6 * make.size_m[1], 0.06})};
  }
  return make;
}

Make make_small_thing(Palette& palette, Draw& draw) {
  Make make;
  if (draw.chance(0.45)) {
    const double diameter = draw.uniform(0.07, 0.16);
    make = {"vase", {diameter, diameter, draw.uniform(0.10, 0.32)}, {}, false, false};
    make.shapes = {make_cylinder_part("", draw.chance(0.5) ? palette.paint() : palette.pot(), {0, 0, 0}, diameter,
                                      make.size_m[2])};
  } else {
    make = {"box", {draw.uniform(0.1, 0.24), draw.uniform(0.12, 0.3), draw.uniform(0.04, 0.24)}, {}, false, false};
    make.shapes = {make_box_part("", draw.chance(0.5) ? palette.paint() : palette.books(), {0, 0, 0}, make.size_m)};
  }
  return make;
}

}  // namespace cgsr::sim
