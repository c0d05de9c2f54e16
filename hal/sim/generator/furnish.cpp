#include "hal/sim/generator/furnish.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

/// One room being furnished.
struct Furnisher {
  Site& site;
  const Room& room;
  Draw& draw;
  Furnished& counted;
  std::vector<Standing> tops{};  ///< where small things can stand.

  /// \return the index in site.standing(), -1: it did not fit.
  int wall(const Make& make, double gap_m = 0.02) {
    const int at = site.put_at_wall(make, room, draw, gap_m);
    if (at < 0) return at;
    ++(make.in_map ? counted.furniture : counted.clutter);
    if (make.in_map && make.flat_top && make.size_m[2] < 1.5)
      tops.push_back(site.standing()[static_cast<std::size_t>(at)]);
    return at;
  }

  /// Somewhere on the floor, turned as drawn.
  int open(const Make& make, double heading_deg, int tries = 10) {
    const FloorRect floor = room.floor();
    for (int i = 0; i < tries; ++i) {
      const double x = draw.uniform(floor.x0 + 0.3, floor.x1 - 0.3);
      const double y = draw.uniform(floor.y0 + 0.3, floor.y1 - 0.3);
      if (!beside({x, y}, make, heading_deg)) continue;
      return static_cast<int>(site.standing().size()) - 1;
    }
    return -1;
  }

  bool beside(const FloorPoint& middle, const Make& make, double heading_deg) {
    if (!site.put_if_it_fits(make, room, middle, heading_deg)) return false;
    ++(make.in_map ? counted.furniture : counted.clutter);
    if (make.in_map && make.flat_top) tops.push_back(site.standing().back());
    return true;
  }

  /// A place in the frame of something that stands.
  [[nodiscard]] static FloorPoint at(const Standing& what, double forward, double left) {
    const double c = cosine(degrees(what.footprint.heading_deg));
    const double s = sine(degrees(what.footprint.heading_deg));
    return {rounded(what.footprint.middle.x + c * forward - s * left),
            rounded(what.footprint.middle.y + s * forward + c * left)};
  }

  [[nodiscard]] double jitter(double most_deg) { return draw.uniform(-most_deg, most_deg); }
};

constexpr double kQuarter_deg = 90.0;

void table_with_chairs(Furnisher& f) {
  const Make table = make_dining_table(f.site.palette(), f.draw);
  const double heading = f.draw.below(2) * kQuarter_deg;
  const int at = f.open(table, heading, 25);
  if (at < 0) return;
  const Standing placed = f.site.standing()[static_cast<std::size_t>(at)];
  const Make chair = f.draw.chance(0.8) ? make_chair(f.site.palette(), f.draw) : make_stool(f.site.palette(), f.draw);
  for (const double side : {-1.0, 1.0}) {
    for (const double along : {-0.25, 0.25}) {
      if (!f.draw.chance(0.7)) continue;
      const double off = side * (table.size_m[0] / 2 + chair.size_m[0] / 2 + f.draw.uniform(0.05, 0.12));
      const FloorPoint p = Furnisher::at(placed, off, along * table.size_m[1]);
      f.beside(p, chair, heading + (side > 0 ? 180.0 : 0.0) + f.jitter(7.0));
    }
  }
}

void add_rug(Furnisher& f, const FloorPoint& middle, double length, double width) {
  const FloorRect floor = f.room.floor();
  const double x = std::clamp(middle.x, floor.x0 + length / 2 + 0.05, floor.x1 - length / 2 - 0.05);
  const double y = std::clamp(middle.y, floor.y0 + width / 2 + 0.05, floor.y1 - width / 2 - 0.05);
  if (length > floor.width() - 0.2 || width > floor.depth() - 0.2) return;
  const std::string name = f.site.fresh("rug");
  ShapeSpec rug;
  rug.name = name;
  rug.kind = f.draw.chance(0.75) ? ShapeKind::kRectangle : ShapeKind::kDisc;
  rug.material = f.site.palette().rug();
  rug.position_m = {rounded(x), rounded(y), 0.004};
  const double round = rounded(std::min(length, width));
  rug.size_m = rug.kind == ShapeKind::kDisc ? Triple{round, round, 0.0} : Triple{rounded(length), rounded(width), 0.0};
  rug.casts_shadow = false;
  f.site.add(rug);
}

void living(Furnisher& f) {
  Palette& palette = f.site.palette();
  const int sofa = f.wall(make_sofa(palette, f.draw));
  if (sofa >= 0) {
    const Standing placed = f.site.standing()[static_cast<std::size_t>(sofa)];
    const double off = placed.footprint.length_m / 2 + f.draw.uniform(0.65, 0.85);
    const FloorPoint before = Furnisher::at(placed, off, 0.0);
    if (f.draw.chance(0.7)) {
      const double length = f.draw.uniform(1.3, 2.2);
      add_rug(f, before, length, f.draw.uniform(1.2, 2.0));
    }
    f.beside(before, make_low_table(palette, f.draw), placed.footprint.heading_deg);
  }
  if (f.draw.chance(0.8)) f.wall(make_television(palette, f.draw));
  if (f.draw.chance(0.75)) f.wall(make_shelf(palette, f.draw));
  if (f.draw.chance(0.4)) f.wall(make_shelf(palette, f.draw));
  if (f.draw.chance(0.6)) f.wall(make_sideboard(palette, f.draw));
  if (f.room.lines.area() > 17.0) table_with_chairs(f);
  if (f.draw.chance(0.6)) f.open(make_armchair(palette, f.draw), f.draw.below(4) * kQuarter_deg + f.jitter(25.0));
  if (f.draw.chance(0.4)) f.open(make_ottoman(palette, f.draw), 0.0);
}

void kitchen(Furnisher& f) {
  Palette& palette = f.site.palette();
  for (double width = f.draw.uniform(2.2, 3.6); width > 1.3; width -= 0.4) {
    if (f.wall(make_kitchen_row(palette, f.draw, rounded(width))) >= 0) break;
  }
  f.wall(make_fridge(palette, f.draw));
  table_with_chairs(f);
  if (f.draw.chance(0.4)) f.wall(make_shelf(palette, f.draw));
}

void bedroom(Furnisher& f) {
  Palette& palette = f.site.palette();
  const int bed = f.wall(make_bed(palette, f.draw));
  if (bed >= 0) {
    const Standing placed = f.site.standing()[static_cast<std::size_t>(bed)];
    const Make table = make_night_table(palette, f.draw);
    for (const double side : {-1.0, 1.0}) {
      if (!f.draw.chance(0.7)) continue;
      const double left = side * (placed.footprint.width_m / 2 + table.size_m[1] / 2 + 0.05);
      const double back = -placed.footprint.length_m / 2 + table.size_m[0] / 2;
      f.beside(Furnisher::at(placed, back, left), table, placed.footprint.heading_deg);
    }
  }
  if (f.draw.chance(0.85)) f.wall(make_wardrobe(palette, f.draw));
  if (f.draw.chance(0.6)) f.wall(make_drawers(palette, f.draw));
  if (f.draw.chance(0.3)) f.wall(make_bench(palette, f.draw));
}

void study(Furnisher& f) {
  Palette& palette = f.site.palette();
  const int desk = f.wall(make_desk(palette, f.draw));
  if (desk >= 0) {
    const Standing placed = f.site.standing()[static_cast<std::size_t>(desk)];
    const Make chair = make_chair(palette, f.draw);
    const double off = placed.footprint.length_m / 2 + chair.size_m[0] / 2 + f.draw.uniform(0.05, 0.2);
    f.beside(Furnisher::at(placed, off, 0.15), chair, placed.footprint.heading_deg + 180.0 + f.jitter(20.0));
  }
  f.wall(make_shelf(palette, f.draw));
  if (f.draw.chance(0.6)) f.wall(make_shelf(palette, f.draw));
  if (f.draw.chance(0.5)) f.wall(make_drawers(palette, f.draw));
  if (f.draw.chance(0.4)) f.wall(make_armchair(palette, f.draw));
}

void hall(Furnisher& f) {
  Palette& palette = f.site.palette();
  if (f.draw.chance(0.8)) f.wall(make_sideboard(palette, f.draw));
  if (f.draw.chance(0.6)) f.wall(make_bench(palette, f.draw));
  if (f.draw.chance(0.6)) f.wall(make_wardrobe(palette, f.draw));
  if (f.draw.chance(0.3)) f.wall(make_drawers(palette, f.draw));
}

void bath(Furnisher& f) {
  Palette& palette = f.site.palette();
  f.wall(make_tub(palette, f.draw));
  f.wall(make_washstand(palette, f.draw));
  if (f.draw.chance(0.6)) f.wall(make_shelf(palette, f.draw));
  if (f.draw.chance(0.4)) f.wall(make_stool(palette, f.draw));
}

void add_pictures(Furnisher& f) {
  const int wanted = f.draw.between(1, 2 + static_cast<int>(f.room.lines.area() / 6.0));
  for (int i = 0; i < wanted; ++i) {
    const double width = f.draw.uniform(0.3, 1.2);
    const double height = f.draw.uniform(0.3, 0.9);
    const double foot = f.draw.uniform(1.05, 1.45);
    const bool known = f.draw.chance(0.85);
    for (int attempt = 0; attempt < 8; ++attempt) {
      const Side side = f.draw.pick(kSides);
      const Range1 range = range_of(f.room, side);
      const double room_m = range.to - range.from - width - 0.3;
      const double along = rounded(range.from + 0.15 + width / 2 + f.draw.share() * room_m);
      if (room_m < 0 || foot + height > f.site.plan().ceiling_m - 0.15) continue;
      if (!f.site.bare(f.room, side, along - width / 2 - 0.08, along + width / 2 + 0.08, foot, foot + height)) continue;
      Make picture{"picture", {0.03, width, height}, {}, known, false};
      ShapeSpec shape;
      shape.kind = ShapeKind::kPicture;
      shape.material = f.draw.chance(0.5) ? f.site.palette().wood() : f.site.palette().metal();
      shape.second_material = f.site.palette().artwork();
      shape.size_m = picture.size_m;
      picture.shapes.push_back(shape);
      const AtWall at = at_wall(f.room, side, along, 0.015);
      f.site.put(picture, at.place, at.heading_deg, foot);
      ++(known ? f.counted.pictures : f.counted.clutter);
      break;
    }
  }
}

/// On the floor beside walls and about, and on top of furniture.
void add_clutter(Furnisher& f) {
  const int on_floor = f.draw.between(0, 1 + static_cast<int>(f.room.lines.area() / 4.0));
  for (int i = 0; i < on_floor; ++i) {
    const Make thing = make_clutter(f.site.palette(), f.draw);
    if (f.draw.chance(0.7)) {
      f.wall(thing, f.draw.uniform(0.02, 0.25));
    } else {
      f.open(thing, f.jitter(180.0), 4);
    }
  }
  if (f.draw.chance(0.6)) f.wall(make_plant(f.site.palette(), f.draw), 0.05);
  if (f.draw.chance(0.25)) {  // a chair that somebody moved
    Make chair = make_chair(f.site.palette(), f.draw);
    chair.name = "moved chair";
    chair.in_map = false;
    f.open(chair, f.jitter(180.0));
  }
  for (const Standing& top : f.tops) {
    const int things = f.draw.between(0, 2);
    for (int i = 0; i < things; ++i) {
      const Make thing = make_small_thing(f.site.palette(), f.draw);
      const double room_x = top.footprint.length_m - thing.size_m[0] - 0.1;
      const double room_y = (top.footprint.width_m / 2 - thing.size_m[1] - 0.06);
      const double forward = f.draw.uniform(-0.5, 0.5) * room_x;
      const double left = (i == 0 ? 1.0 : -1.0) * (thing.size_m[1] / 2 + 0.03 + f.draw.share() * room_y);
      if (room_x < 0 || room_y < 0) continue;
      f.site.put(thing, Furnisher::at(top, forward, left), top.footprint.heading_deg + f.jitter(20.0), top.to_m);
      ++f.counted.clutter;
    }
  }
}

}  // namespace

Furnished furnish(Site& site, Draw& draw) {
  Furnished counted;
  for (const Room& room : site.plan().rooms) {
    Furnisher furnisher{site, room, draw, counted};
    switch (room.kind) {
      case RoomKind::kLiving:
        living(furnisher);
        break;
      case RoomKind::kKitchen:
        kitchen(furnisher);
        break;
      case RoomKind::kBedroom:
        bedroom(furnisher);
        break;
      case RoomKind::kStudy:
        study(furnisher);
        break;
      case RoomKind::kHall:
        hall(furnisher);
        break;
      case RoomKind::kBath:
        bath(furnisher);
        break;
    }
    add_pictures(furnisher);
    add_clutter(furnisher);
  }
  return counted;
}

}  // namespace cgsr::sim
