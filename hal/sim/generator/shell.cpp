#include "hal/sim/generator/shell.h"

#include <algorithm>
#include <string>
#include <utility>

namespace cgsr::sim {
namespace {

constexpr double kFrame_m = 0.05;  // of a door's frame, outside of what it leaves free

ShapeSpec box(std::string name, std::string material, const Triple& foot, const Triple& size) {
  ShapeSpec spec;
  spec.name = std::move(name);
  spec.material = std::move(material);
  spec.position_m = {rounded(foot[0]), rounded(foot[1]), rounded(foot[2])};
  spec.size_m = {rounded(size[0]), rounded(size[1]), rounded(size[2])};
  return spec;
}

/// A box in a wall: `along` its middle, `aside` off the wall's middle line.
ShapeSpec in_wall(const Wall& wall, std::string name, std::string material, double along, double aside, double foot,
                  const Triple& size) {
  if (wall.along_x) return box(std::move(name), std::move(material), {along, wall.at + aside, foot}, size);
  return box(std::move(name), std::move(material), {wall.at + aside, along, foot}, {size[1], size[0], size[2]});
}

/// Into the home from an outer wall: +1 along x or y, or -1.
double inwards(const FloorPlan& plan, const Wall& wall) {
  return wall.at == (wall.along_x ? plan.outline.y0 : plan.outline.x0) ? 1.0 : -1.0;
}

void add_floors(Site& site, Draw& draw) {
  for (const Room& room : site.plan().rooms) {
    const bool wet = room.kind == RoomKind::kKitchen || room.kind == RoomKind::kBath;
    ShapeSpec floor = box(room.name + " floor", site.palette().floor(draw.chance(wet ? 0.8 : 0.15)),
                          {room.lines.x(), room.lines.y(), 0.0}, {room.lines.width(), room.lines.depth(), 0.0});
    floor.kind = ShapeKind::kRectangle;
    site.add(floor);
  }
  const FloorRect& o = site.plan().outline;
  site.add(box("ceiling", site.palette().ceiling(), {o.x(), o.y(), site.plan().ceiling_m},
               {o.width() + 0.3, o.depth() + 0.3, 0.1}));
}

void add_door_frame(Site& site, const Wall& wall, const Opening& door, const std::string& material) {
  const std::string name = site.fresh("door frame");
  const double depth = kWall_m + 0.04;
  for (const double along : {door.from - kFrame_m / 2, door.to + kFrame_m / 2}) {
    site.add(in_wall(wall, name, material, along, 0.0, 0.0, {kFrame_m, depth, door.head_m + kFrame_m}));
  }
  site.add(in_wall(wall, name, material, (door.from + door.to) / 2, 0.0, door.head_m,
                   {door.to - door.from, depth, kFrame_m}));
}

/// Wall between, below and above the openings.
void add_wall(Site& site, const Wall& wall, const std::string& name) {
  const std::string material = site.palette().wall();
  const double ceiling = site.plan().ceiling_m;
  double from = wall.from;
  const auto piece = [&](double low, double high, double foot, double head) {
    if (high - low < 0.005 || head - foot < 0.005) return;
    site.add(in_wall(wall, name, material, (low + high) / 2, 0.0, foot, {high - low, kWall_m, head - foot}));
  };
  for (const Opening& opening : wall.openings) {
    const double frame = opening.kind == OpeningKind::kDoor ? kFrame_m : 0.0;
    piece(from, opening.from - frame, 0.0, ceiling);
    piece(opening.from - frame, opening.to + frame, opening.head_m + frame, ceiling);
    piece(opening.from, opening.to, 0.0, opening.sill_m);
    from = opening.to + frame;
  }
  piece(from, wall.to, 0.0, ceiling);
}

void add_window(Site& site, const Wall& wall, const Opening& window, const std::string& sky, Draw& draw) {
  const double in = inwards(site.plan(), wall);
  const double middle = (window.from + window.to) / 2;
  const double width = window.to - window.from;
  const double height = window.head_m - window.sill_m;
  const std::string white = site.palette().white();
  const std::string name = site.fresh("window");
  site.add(in_wall(wall, name + " sill", white, middle, in * 0.09, window.sill_m - 0.03, {width + 0.1, 0.2, 0.03}));
  const int bars = draw.between(0, 2);
  for (int i = 1; i <= bars; ++i) {
    ShapeSpec bar = in_wall(wall, name + " bar", white, window.from + i * width / (bars + 1), 0.0, window.sill_m,
                            {0.05, 0.05, height});
    bar.in_map = false;
    site.add(bar);
  }
  ShapeSpec pane = in_wall(wall, name + " sky", sky, middle, -in * 0.4, std::max(0.0, window.sill_m - 0.4),
                           {width + 1.2, 0.0, height + 0.8});
  pane.kind = ShapeKind::kRectangle;
  pane.casts_shadow = false;
  pane.in_map = false;
  site.add(pane);
  if (!draw.chance(0.65)) return;
  const std::string cloth = site.palette().curtain();
  const double wide = draw.uniform(0.25, 0.45);
  const double foot = draw.chance(0.6) ? 0.05 : rounded(window.sill_m - 0.15);
  for (const double along : {window.from - wide / 2 + 0.08, window.to + wide / 2 - 0.08}) {
    const ShapeSpec curtain = in_wall(wall, name + " curtain", cloth, along, in * (kWall_m / 2 + 0.08), foot,
                                      {wide, 0.06, window.head_m + 0.12 - foot});
    site.add(curtain);
    site.reserve({{{curtain.position_m[0], curtain.position_m[1]}, curtain.size_m[0], curtain.size_m[1], 0.0},
                  foot,
                  window.head_m + 0.12});
  }
}

/// Along every wall of a room, but not where a door is.
void add_skirtings(Site& site) {
  const std::string material = site.palette().skirting();
  for (const Room& room : site.plan().rooms) {
    const std::string name = room.name + " skirting";
    for (const Side side : kSides) {
      const Range1 range = range_of(room, side);
      double from = range.from;
      const auto piece = [&](double to) {
        if (to - from < 0.05) return;
        const FloorPoint p = at_wall(room, side, (from + to) / 2, 0.008).place;
        const bool along_x = side == Side::kSouth || side == Side::kNorth;
        site.add(box(name, material, {p.x, p.y, 0.0},
                     along_x ? Triple{to - from, 0.016, 0.09} : Triple{0.016, to - from, 0.09}));
      };
      for (const Opening& opening : wall_on(site.plan(), room, side)->openings) {
        if (opening.kind == OpeningKind::kWindow || opening.to < range.from || opening.from > range.to) continue;
        piece(opening.from - kFrame_m);
        from = opening.to + kFrame_m;
      }
      piece(range.to);
    }
  }
}

/// A closed door to the outside: it is only seen.
void add_front_door(Site& site, Draw& draw) {
  for (int i = 0; i < 40; ++i) {
    const Room& room =
        site.plan().rooms[static_cast<std::size_t>(draw.below(static_cast<int>(site.plan().rooms.size())))];
    const Side side = draw.pick(kSides);
    const double where = draw.share();
    const Wall* wall = wall_on(site.plan(), room, side);
    if (wall == nullptr || !wall->outer) continue;
    const Range1 range = range_of(room, side);
    const double along = rounded(range.from + 0.7 + where * (range.to - range.from - 1.4));
    if (!site.bare(room, side, along - 0.52, along + 0.52, 0.0, 2.1)) continue;
    const AtWall at = at_wall(room, side, along, 0.015);
    Make door{"front door", {0.06, 0.98, 2.08}, {}, true, false};
    door.shapes = {box("frame", site.palette().wood(), {0, 0, 0}, {0.03, 0.98, 2.08}),
                   box("leaf", site.palette().white(), {0.015, 0, 0}, {0.06, 0.86, 2.02}),
                   box("handle", site.palette().metal(), {0.06, 0.36, 1.0}, {0.04, 0.12, 0.03})};
    door.shapes.back().in_map = false;
    site.put(door, at.place, at.heading_deg);
    site.keep_free(Footprint{at_wall(room, side, along, 0.4).place, 0.8, 0.9, at.heading_deg}.bounds());
    return;
  }
}

}  // namespace

void build_shell(Site& site, Draw& draw) {
  add_floors(site, draw);
  const std::string frame = draw.chance(0.6) ? site.palette().white() : site.palette().wood();
  const std::string sky = site.palette().sky();
  for (const Wall& wall : site.plan().walls) {
    add_wall(site, wall, site.fresh(wall.outer ? "outer wall" : "inner wall"));
    for (const Opening& opening : wall.openings) {
      if (opening.kind == OpeningKind::kWindow) add_window(site, wall, opening, sky, draw);
      if (opening.kind == OpeningKind::kDoor) add_door_frame(site, wall, opening, frame);
    }
  }
  add_skirtings(site);
  add_front_door(site, draw);
}

}  // namespace cgsr::sim
