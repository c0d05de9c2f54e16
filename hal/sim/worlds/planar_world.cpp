#include "hal/sim/worlds/planar_world.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

constexpr double kRaise_m = 0.001;  // what lies on something lies a millimetre above it
constexpr int kBoardEdges = 9 * 8 + 10 * 7;

ShapeSpec flat(const std::string& name, const char* material, const Triple& position, const Triple& size,
               double heading_deg = 0.0) {
  ShapeSpec shape;
  shape.name = name;
  shape.kind = ShapeKind::kRectangle;
  shape.material = material;
  shape.position_m = position;
  shape.size_m = size;
  shape.heading_deg = heading_deg;
  shape.casts_shadow = size[2] > 0.0;
  return shape;
}

MaterialSpec matt(const char* name, const Triple& srgb, PatternKind pattern = PatternKind::kPlain,
                  const Triple& second = {0, 0, 0}) {
  MaterialSpec material;
  material.name = name;
  material.albedo = srgb;
  material.pattern = pattern;
  material.second = second;
  material.size_m = 0.02;
  return material;
}

// The tape: five lines each way, 5 cm wide, 1 m apart.
void add_tape(std::vector<ShapeSpec>& shapes) {
  for (int i = 0; i <= 4; ++i) {
    shapes.push_back(
        flat(fmt::format("tape across {}", i), "planar tape", {1.2 + i, 0.0, 2 * kRaise_m}, {0.05, 4.05, 0.0}));
  }
  for (int i = 0; i <= 4; ++i) {
    shapes.push_back(
        flat(fmt::format("tape along {}", i), "planar tape", {3.2, i - 2.0, 3 * kRaise_m}, {4.05, 0.05, 0.0}));
  }
}

// The field lies across the view: 6 m along y, 4 m along x, its centre 8.2 m ahead. 25 lines.
void add_field(std::vector<ShapeSpec>& shapes) {
  constexpr double kX = 8.2;
  const auto line = [&](const char* name, double x, double y, double size_x, double size_y, double heading = 0.0) {
    shapes.push_back(flat(name, "planar line", {kX + x, y, 4 * kRaise_m}, {size_x, size_y, 0.0}, heading));
  };
  shapes.push_back(flat("carpet", "planar carpet", {kX, 0.0, kRaise_m}, {5.0, 7.4, 0.0}));
  line("near touch line", -2.0, 0.0, 0.05, 6.05);
  line("far touch line", 2.0, 0.0, 0.05, 6.05);
  line("left goal line", 0.0, 3.0, 3.94, 0.05);
  line("right goal line", 0.0, -3.0, 3.94, 0.05);
  line("centre line", 0.0, 0.0, 3.94, 0.05);
  for (const double side : {1.0, -1.0}) {
    line("box line", 0.0, side * 2.4, 2.0, 0.05);
    line("box side", -1.0, side * 2.7, 0.05, 0.54);
    line("box side", 1.0, side * 2.7, 0.05, 0.54);
    line("penalty mark", 0.0, side * 1.8, 0.10, 0.10, 45.0);
  }
  for (int i = 0; i < 12; ++i) {
    const double around = 2.0 * kPi * (i + 0.5) / 12;
    line("circle", 0.6 * cosine(around), 0.6 * sine(around), 0.05, 0.285, 360.0 * (i + 0.5) / 12);
  }
}

std::vector<ShapeSpec> rectangles() {
  std::vector<ShapeSpec> shapes;
  shapes.push_back(flat("ground", "planar ground", {3.0, 0.0, 0.0}, {24.0, 14.0, 0.0}));
  shapes.push_back(flat("left goal", "planar yellow", {8.2, 3.25, kRaise_m}, {0.0, 0.80, 0.40}, -90.0));
  shapes.push_back(flat("right goal", "planar blue", {8.2, -3.25, kRaise_m}, {0.0, 0.80, 0.40}, 90.0));
  shapes.push_back(flat("board 1", "planar board", {3.2, 2.9, kRaise_m}, {0.0, 1.20, 0.90}, -100.0));
  shapes.push_back(flat("board 2", "planar board", {3.4, -2.8, kRaise_m}, {0.0, 1.20, 0.90}, 105.0));
  shapes.push_back(flat("board 3", "planar board", {5.5, 2.35, kRaise_m}, {0.0, 1.00, 0.80}, 205.0));
  shapes.push_back(flat("board 4", "planar board", {5.6, -2.35, kRaise_m}, {0.0, 1.00, 0.80}, 155.0));
  add_tape(shapes);
  add_field(shapes);
  return shapes;
}

ShapeSpec checkerboard(int index, int columns, int rows) {
  ShapeSpec shape = flat(fmt::format("checkerboard {}", index), "planar black", {5.4, index == 1 ? 0.75 : -0.75, 0.02},
                         {0.0, 0.09 * columns, 0.09 * rows}, index == 1 ? 190.0 : 170.0);
  shape.kind = ShapeKind::kCheckerboard;
  shape.second_material = "planar board";
  shape.columns = columns;
  shape.rows = rows;
  return shape;
}

// Boxes in rows behind the start, from small to tall, as crates in a store room.
void add_clutter(int boxes, bool beside, std::vector<ShapeSpec>& shapes) {
  const int columns = std::max(8, static_cast<int>(std::sqrt(static_cast<double>(boxes))));
  for (int i = 0; i < boxes; ++i) {
    ShapeSpec box = flat(fmt::format("crate {}", i),
                         i % 3 == 0   ? "planar board"
                         : i % 3 == 1 ? "planar yellow"
                                      : "planar blue",
                         {}, {});
    const auto seed = static_cast<std::uint32_t>(i);
    box.kind = ShapeKind::kBox;
    box.casts_shadow = true;
    box.size_m = {0.15 + 0.2 * static_cast<double>(unit(mix(seed, 1U))),
                  0.15 + 0.2 * static_cast<double>(unit(mix(seed, 2U))),
                  0.1 + 0.5 * static_cast<double>(unit(mix(seed, 3U)))};
    const int row = i / columns;
    const int steps_aside = i % columns - columns / 2;
    box.position_m = {-2.0 - 0.5 * row, 0.5 * steps_aside, beside ? 2 * kRaise_m : kRaise_m};
    box.heading_deg = 90.0 * static_cast<double>(unit(mix(seed, 4U)));
    shapes.push_back(box);
  }
}

}  // namespace

void add_planar_world(const PlanarSpec& planar, WorldSpec& world) {
  for (const MaterialSpec& material :
       {matt("planar ground", {0.62, 0.60, 0.57}, PatternKind::kFabric, {0.55, 0.53, 0.51}),
        matt("planar tape", {0.16, 0.16, 0.18}),
        matt("planar carpet", {0.16, 0.45, 0.22}, PatternKind::kFabric, {0.13, 0.40, 0.19}),
        matt("planar line", {0.93, 0.93, 0.91}), matt("planar board", {0.94, 0.94, 0.93}),
        matt("planar black", {0.10, 0.10, 0.10}), matt("planar yellow", {0.93, 0.80, 0.12}),
        matt("planar blue", {0.12, 0.27, 0.65})}) {
    world.material.push_back(material);
  }
  std::vector<ShapeSpec> all = rectangles();
  const int wanted = planar.edges;
  const auto kept = std::min(all.size(), static_cast<std::size_t>(wanted / 4));
  all.resize(kept);
  int left = wanted - 4 * static_cast<int>(kept);
  for (int board = 1; board <= 2 && left >= 12; ++board) {  // as many whole rows of nine as fit, then a narrower row
    const int rows = std::min(7, (left - 9) / 19);
    if (rows < 1) break;
    all.push_back(checkerboard(board, 9, rows));
    left -= rows == 7 ? kBoardEdges : 9 * (rows + 1) + 10 * rows;
  }
  const int behind = (planar.half_behind ? wanted : 0) + left;
  add_clutter(behind / 12, planar.half_behind, all);
  world.shape.insert(world.shape.end(), all.begin(), all.end());
}

}  // namespace cgsr::sim
