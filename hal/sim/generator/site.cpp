#include "hal/sim/generator/site.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

constexpr double kBesideThings_m = 0.03;
constexpr double kBeforeDoor_m = 0.9;
constexpr double kBeforeWindow_m = 0.5;
constexpr double kRobotHeight_m = 1.5;  // what hangs higher is in nobody's way
constexpr int kTries = 12;
constexpr double kMinFree_m2 = 1.0;   // of a room, where the middle of the robot can be
constexpr double kMinReached = 0.8;   // of the places in a room where the robot would fit
constexpr double kDoorstep_m = 0.55;  // beside the wall's middle

FloorRect across(const Wall& wall, const Opening& opening, double depth_m, double wider_m) {
  const FloorRect along{opening.from - wider_m, wall.at - depth_m, opening.to + wider_m, wall.at + depth_m};
  return wall.along_x ? along : FloorRect{along.y0, along.x0, along.y1, along.x1};
}

/// The pieces of a wall between what can be driven through.
std::vector<FloorRect> solid_pieces(const Wall& wall) {
  std::vector<FloorRect> pieces;
  double from = wall.from;
  const auto add = [&](double to) {
    FloorRect piece{from, wall.at - kWall_m / 2, to, wall.at + kWall_m / 2};
    if (!wall.along_x) piece = {piece.y0, piece.x0, piece.y1, piece.x1};
    if (to > from) pieces.push_back(piece);
  };
  for (const Opening& opening : wall.openings) {
    if (opening.kind == OpeningKind::kWindow) continue;
    add(opening.from);
    from = opening.to;
  }
  add(wall.to);
  return pieces;
}

}  // namespace

AtWall at_wall(const Room& room, Side side, double along, double off_m) {
  const FloorRect f = room.floor();
  switch (side) {
    case Side::kSouth:
      return {{along, f.y0 + off_m}, 90.0};
    case Side::kNorth:
      return {{along, f.y1 - off_m}, -90.0};
    case Side::kWest:
      return {{f.x0 + off_m, along}, 0.0};
    case Side::kEast:
      return {{f.x1 - off_m, along}, 180.0};
  }
  return {};
}

Range1 range_of(const Room& room, Side side) {
  const FloorRect f = room.floor();
  return side == Side::kSouth || side == Side::kNorth ? Range1{f.x0, f.x1} : Range1{f.y0, f.y1};
}

const Wall* wall_on(const FloorPlan& plan, const Room& room, Side side) {
  const bool along_x = side == Side::kSouth || side == Side::kNorth;
  const double at = side == Side::kSouth   ? room.lines.y0
                    : side == Side::kNorth ? room.lines.y1
                    : side == Side::kWest  ? room.lines.x0
                                           : room.lines.x1;
  const Range1 range = range_of(room, side);
  for (const Wall& wall : plan.walls) {
    if (wall.along_x == along_x && wall.at == at && wall.from < range.to && range.from < wall.to) return &wall;
  }
  return nullptr;
}

Site::Site(const FloorPlan& plan, WorldSpec& world, Palette palette)
    : plan_(&plan), world_(&world), palette_(std::move(palette)), floor_(plan.outline) {
  for (const Wall& wall : plan.walls) {
    for (const FloorRect& piece : solid_pieces(wall)) floor_.add(footprint_of(piece));
    for (const Opening& opening : wall.openings) {
      if (opening.kind == OpeningKind::kWindow) {
        before_windows_.push_back(across(wall, opening, kBeforeWindow_m, 0.0));
        sills_m_.push_back(opening.sill_m);
      } else {
        before_doors_.push_back(across(wall, opening, kBeforeDoor_m, 0.05));
      }
    }
  }
}

std::string Site::fresh(const std::string& name) {
  const int number = ++names_[name];
  return number == 1 ? name : fmt::format("{} {}", name, number);
}

std::string Site::put(const Make& make, const FloorPoint& middle, double heading_deg, double foot_m) {
  std::string name = fresh(make.name);
  heading_deg = rounded(heading_deg > 180.0 ? heading_deg - 360.0 : heading_deg);
  const double c = cosine(degrees(heading_deg));
  const double s = sine(degrees(heading_deg));
  for (ShapeSpec shape : make.shapes) {
    const Triple p = shape.position_m;
    shape.name = shape.name.empty() ? name : name + "/" + shape.name;
    shape.position_m = {rounded(middle.x + c * p[0] - s * p[1]), rounded(middle.y + s * p[0] + c * p[1]),
                        rounded(foot_m + p[2])};
    shape.heading_deg = heading_deg;
    shape.in_map = shape.in_map && make.in_map;
    world_->shape.push_back(std::move(shape));
  }
  reserve({{middle, make.size_m[0], make.size_m[1], heading_deg}, foot_m, foot_m + make.size_m[2]});
  return name;
}

void Site::reserve(const Standing& standing) {
  standing_.push_back(standing);
  if (standing.from_m < kRobotHeight_m) floor_.add(standing.footprint);
}

bool Site::is_air(const FloorPoint& p, double height_m) const {
  return std::none_of(standing_.begin(), standing_.end(), [&](const Standing& thing) {
    return height_m > thing.from_m - 0.2 && height_m < thing.to_m + 0.2 && thing.footprint.distance_to(p) < 0.2;
  });
}

bool Site::free_of_others(const Standing& standing) const {
  const FloorRect rect = standing.footprint.bounds().inset(-kBesideThings_m);
  for (const Standing& other : standing_) {
    if (rect.overlaps(other.footprint.bounds()) && standing.from_m < other.to_m && other.from_m < standing.to_m) {
      return false;
    }
  }
  for (const FloorRect& door : before_doors_) {
    if (rect.overlaps(door)) return false;
  }
  for (std::size_t i = 0; i < before_windows_.size(); ++i) {
    if (standing.to_m > sills_m_[i] && rect.overlaps(before_windows_[i])) return false;
  }
  return true;
}

bool Site::put_if_it_fits(const Make& make, const Room& room, const FloorPoint& middle, double heading_deg) {
  const Standing standing{{middle, make.size_m[0], make.size_m[1], heading_deg}, 0.0, make.size_m[2]};
  const FloorRect rect = standing.footprint.bounds();
  const FloorRect floor = room.floor();
  if (rect.x0 < floor.x0 || rect.y0 < floor.y0 || rect.x1 > floor.x1 || rect.y1 > floor.y1) return false;
  if (make.size_m[2] > plan_->ceiling_m - 0.1) return false;
  if (!free_of_others(standing) || !drivable(&standing)) return false;
  put(make, middle, heading_deg);
  return true;
}

int Site::put_at_wall(const Make& make, const Room& room, Draw& draw, double gap_m) {
  for (int i = 0; i < kTries; ++i) {
    const Side side = draw.pick(kSides);
    const double half = make.size_m[1] / 2.0 + 0.02;
    const Range1 range = range_of(room, side);
    const double where = draw.share();
    if (range.to - range.from < 2.0 * half) continue;
    // Corners are as likely as all the rest of a wall.
    const double share = std::clamp(2.0 * where - 0.5, 0.0, 1.0);
    const double along = rounded(range.from + half + share * (range.to - range.from - 2.0 * half));
    const AtWall at = at_wall(room, side, along, rounded(make.size_m[0] / 2.0 + gap_m));
    if (put_if_it_fits(make, room, at.place, at.heading_deg)) return static_cast<int>(standing_.size()) - 1;
  }
  return -1;
}

bool Site::bare(const Room& room, Side side, double from, double to, double low_m, double high_m) const {
  const Range1 range = range_of(room, side);
  if (from < range.from + 0.1 || to > range.to - 0.1) return false;
  const Wall* wall = wall_on(*plan_, room, side);
  if (wall == nullptr) return false;
  for (const Opening& opening : wall->openings) {
    const double beside = opening.kind == OpeningKind::kWindow ? 0.1 : 0.12;
    if (from < opening.to + beside && opening.from - beside < to && low_m < opening.head_m + 0.1) return false;
  }
  const AtWall a = at_wall(room, side, from, 0.0);
  const AtWall b = at_wall(room, side, to, 0.12);
  const FloorRect strip{std::min(a.place.x, b.place.x), std::min(a.place.y, b.place.y), std::max(a.place.x, b.place.x),
                        std::max(a.place.y, b.place.y)};
  return std::none_of(standing_.begin(), standing_.end(), [&](const Standing& other) {
    return strip.overlaps(other.footprint.bounds()) && low_m < other.to_m && other.from_m < high_m;
  });
}

bool Site::drivable(const Standing* with) const {
  FreeFloor floor = floor_;
  if (with != nullptr && with->from_m < kRobotHeight_m) floor.add(with->footprint);
  std::vector<FloorPoint> steps;
  for (const FloorPlan::Door& door : plan_->doors()) {
    const double along = (door.opening->from + door.opening->to) / 2.0;
    for (const double off : {-kDoorstep_m, 0.0, kDoorstep_m}) {
      const double at = door.wall->at + off;
      steps.push_back(door.wall->along_x ? FloorPoint{along, at} : FloorPoint{at, along});
    }
  }
  const std::vector<bool> reached = floor.reached_from(steps.front(), kRobotRadius_m);
  for (const FloorPoint& step : steps) {
    if (!reached[floor.cell_at(step)]) return false;
  }
  std::vector<int> free(plan_->rooms.size(), 0);
  std::vector<int> got(plan_->rooms.size(), 0);
  for (std::size_t cell = 0; cell < reached.size(); ++cell) {
    const FloorPoint p = floor.middle_of(cell);
    if (!floor.is_free(p, kRobotRadius_m)) continue;
    const int room = plan_->room_at(p.x, p.y);
    if (room < 0) continue;
    ++free[static_cast<std::size_t>(room)];
    got[static_cast<std::size_t>(room)] += reached[cell] ? 1 : 0;
  }
  for (std::size_t i = 0; i < free.size(); ++i) {
    const double area = got[i] * FreeFloor::kCell_m * FreeFloor::kCell_m;
    if (area < kMinFree_m2 || got[i] < kMinReached * free[i]) return false;
  }
  return true;
}

}  // namespace cgsr::sim
