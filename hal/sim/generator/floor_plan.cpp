#include "hal/sim/generator/floor_plan.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace cgsr::sim {
namespace {

constexpr double kMinSide_m = 2.5;     // of a room, between the middle lines
constexpr double kFromCorner_m = 0.3;  // of an opening, from where two walls meet

double to_decimetre(double value) {
  return std::round(value * 10.0) / 10.0;
}

bool can_be_cut(const FloorRect& room) {
  return std::max(room.width(), room.depth()) >= 2.0 * kMinSide_m;
}

/// Cuts one room in two; the wall between them is added.
void cut(FloorPlan& plan, std::size_t which, Draw& draw) {
  const FloorRect room = plan.rooms[which].lines;
  const bool wide = room.width() >= 2.0 * kMinSide_m;
  const bool deep = room.depth() >= 2.0 * kMinSide_m;
  const bool across = wide && (!deep || draw.chance(room.width() > room.depth() ? 0.8 : 0.2));
  Wall wall;
  wall.along_x = !across;
  FloorRect first = room;
  FloorRect second = room;
  if (across) {
    wall.at = to_decimetre(draw.uniform(room.x0 + kMinSide_m, room.x1 - kMinSide_m));
    first.x1 = second.x0 = wall.at;
  } else {
    wall.at = to_decimetre(draw.uniform(room.y0 + kMinSide_m, room.y1 - kMinSide_m));
    first.y1 = second.y0 = wall.at;
  }
  wall.from = (across ? room.y0 : room.x0) + kWall_m / 2.0;
  wall.to = (across ? room.y1 : room.x1) - kWall_m / 2.0;
  plan.walls.push_back(wall);
  plan.rooms[which].lines = first;
  plan.rooms.push_back({"", RoomKind::kLiving, second});
}

void add_outer_walls(FloorPlan& plan) {
  const FloorRect& o = plan.outline;
  const double half = kWall_m / 2.0;
  plan.walls.push_back({true, o.y0, o.x0 - half, o.x1 + half, true, {}});
  plan.walls.push_back({true, o.y1, o.x0 - half, o.x1 + half, true, {}});
  plan.walls.push_back({false, o.x0, o.y0 + half, o.y1 - half, true, {}});
  plan.walls.push_back({false, o.x1, o.y0 + half, o.y1 - half, true, {}});
}

/// A piece of a wall with a room on either side of it, or with one and the outside.
struct Stretch {
  std::size_t wall = 0;
  int a = 0;
  int b = -1;
  double from = 0.0;
  double to = 0.0;
};

std::vector<Stretch> stretches(const FloorPlan& plan) {
  std::vector<Stretch> found;
  for (std::size_t w = 0; w < plan.walls.size(); ++w) {
    const Wall& wall = plan.walls[w];
    std::vector<std::pair<int, FloorRect>> before;
    std::vector<std::pair<int, FloorRect>> after;
    for (std::size_t r = 0; r < plan.rooms.size(); ++r) {
      const FloorRect& room = plan.rooms[r].lines;
      if ((wall.along_x ? room.y1 : room.x1) == wall.at) before.emplace_back(static_cast<int>(r), room);
      if ((wall.along_x ? room.y0 : room.x0) == wall.at) after.emplace_back(static_cast<int>(r), room);
    }
    const auto add = [&](int a, int b, const FloorRect& one, const FloorRect& other) {
      const double from = std::max({wall.along_x ? one.x0 : one.y0, wall.along_x ? other.x0 : other.y0, wall.from});
      const double to = std::min({wall.along_x ? one.x1 : one.y1, wall.along_x ? other.x1 : other.y1, wall.to});
      if (to - from > kMinDoor_m) found.push_back({w, a, b, from, to});
    };
    if (wall.outer) {
      for (const auto& [room, rect] : before) add(room, -1, rect, rect);
      for (const auto& [room, rect] : after) add(room, -1, rect, rect);
      continue;
    }
    for (const auto& [a, one] : before) {
      for (const auto& [b, other] : after) add(a, b, one, other);
    }
  }
  return found;
}

/// A door or a passage into the stretch. \return whether it fits.
bool open_door(FloorPlan& plan, const Stretch& stretch, Draw& draw) {
  Opening opening;
  const bool passage = draw.chance(0.3);
  opening.kind = passage ? OpeningKind::kPassage : OpeningKind::kDoor;
  const double room_m = stretch.to - stretch.from - 2.0 * kFromCorner_m;
  if (room_m < kMinDoor_m) return false;
  const double width = std::min(passage ? draw.uniform(1.0, 1.8) : draw.uniform(kMinDoor_m, 1.05), room_m);
  opening.from = rounded(stretch.from + kFromCorner_m + draw.share() * (room_m - width));
  opening.to = rounded(opening.from + width);
  opening.head_m = passage ? draw.uniform(2.1, 2.3) : draw.uniform(2.0, 2.1);
  opening.room_a = stretch.a;
  opening.room_b = stretch.b;
  plan.walls[stretch.wall].openings.push_back(opening);
  return true;
}

int root_of(std::vector<int>& parent, int room) {
  while (parent[static_cast<std::size_t>(room)] != room) room = parent[static_cast<std::size_t>(room)];
  return room;
}

/// A tree of doors over all rooms in random order, and some doors more. \return whether every room is joined.
bool join_rooms(FloorPlan& plan, const std::vector<Stretch>& all, Draw& draw) {
  std::vector<Stretch> inner;
  std::copy_if(all.begin(), all.end(), std::back_inserter(inner), [](const Stretch& s) { return s.b >= 0; });
  for (std::size_t i = inner.size(); i > 1; --i) {
    std::swap(inner[i - 1], inner[static_cast<std::size_t>(draw.below(static_cast<int>(i)))]);
  }
  std::vector<int> parent(plan.rooms.size());
  std::iota(parent.begin(), parent.end(), 0);
  std::size_t joined = 1;
  const double more = draw.uniform(0.0, 0.6);
  std::set<std::pair<int, int>> pairs;
  for (const Stretch& stretch : inner) {
    const int a = root_of(parent, stretch.a);
    const int b = root_of(parent, stretch.b);
    const bool needed = a != b;
    if (!pairs.emplace(std::min(stretch.a, stretch.b), std::max(stretch.a, stretch.b)).second) continue;
    if (!needed && !draw.chance(more)) continue;
    if (!open_door(plan, stretch, draw)) continue;
    if (needed) {
      parent[static_cast<std::size_t>(a)] = b;
      ++joined;
    }
  }
  return joined == plan.rooms.size();
}

void add_windows(FloorPlan& plan, const std::vector<Stretch>& all, Draw& draw) {
  bool any = false;
  for (const Stretch& stretch : all) {
    const double room_m = stretch.to - stretch.from - 2.0 * 0.6;
    if (stretch.b >= 0 || room_m < 0.7 || (any && !draw.chance(0.45))) continue;
    Opening window;
    window.kind = OpeningKind::kWindow;
    const double width = std::min(draw.uniform(0.7, 2.0), room_m);
    window.from = rounded(stretch.from + 0.6 + draw.share() * (room_m - width));
    window.to = rounded(window.from + width);
    window.sill_m = draw.uniform(0.75, 1.05);
    window.head_m = draw.uniform(1.95, 2.2);
    window.room_a = stretch.a;
    plan.walls[stretch.wall].openings.push_back(window);
    any = true;
  }
}

/// The largest room is for living, the kitchen comes next or not, the others are drawn.
void name_rooms(FloorPlan& plan, Draw& draw) {
  std::vector<std::size_t> order(plan.rooms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return plan.rooms[a].lines.area() > plan.rooms[b].lines.area();
  });
  constexpr std::array kOthers{RoomKind::kKitchen, RoomKind::kBedroom, RoomKind::kStudy, RoomKind::kHall,
                               RoomKind::kBath};
  constexpr std::array<const char*, 6> kNames{"living room", "kitchen", "bedroom", "study", "hall", "bath"};
  std::array<int, 6> counts{};
  for (std::size_t i = 0; i < order.size(); ++i) {
    Room& room = plan.rooms[order[i]];
    room.kind = i == 0 ? RoomKind::kLiving : draw.pick(kOthers);
    if (room.kind == RoomKind::kBath && room.lines.area() > 12.0) room.kind = RoomKind::kBedroom;
    if (room.kind == RoomKind::kKitchen && counts[1] > 0) room.kind = RoomKind::kBedroom;
    const auto kind = static_cast<std::size_t>(room.kind);
    const int number = ++counts[kind];
    room.name = number == 1 ? std::string(kNames[kind]) : fmt::format("{} {}", kNames[kind], number);
  }
}

}  // namespace

FloorRect Room::floor() const {
  return lines.inset(kWall_m / 2.0);
}

std::vector<FloorPlan::Door> FloorPlan::doors() const {
  std::vector<Door> found;
  for (const Wall& wall : walls) {
    for (const Opening& opening : wall.openings) {
      if (opening.kind != OpeningKind::kWindow) found.push_back({&wall, &opening});
    }
  }
  return found;
}

int FloorPlan::room_at(double x, double y) const {
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    if (rooms[i].floor().contains(x, y)) return static_cast<int>(i);
  }
  return -1;
}

std::string FloorPlan::door_graph() const {
  std::vector<int> number(rooms.size());
  std::iota(number.begin(), number.end(), 0);
  std::vector<std::pair<int, int>> best;
  const std::vector<Door> all = doors();
  do {
    std::vector<std::pair<int, int>> edges;
    for (const Door& door : all) {
      const int a = number[static_cast<std::size_t>(door.opening->room_a)];
      const int b = number[static_cast<std::size_t>(door.opening->room_b)];
      edges.emplace_back(std::min(a, b), std::max(a, b));
    }
    std::sort(edges.begin(), edges.end());
    if (best.empty() || edges < best) best = edges;
  } while (std::next_permutation(number.begin(), number.end()));
  std::string text = fmt::format("{}:", rooms.size());
  for (const auto& [a, b] : best) text += fmt::format("{}{}-{}", text.back() == ':' ? "" : ",", a, b);
  return text;
}

std::string FloorPlan::layout() const {
  std::string best;
  for (int turn = 0; turn < 8; ++turn) {
    const auto halves = [](double v) { return static_cast<int>(std::lround(v * 2.0 + 1e-6)); };
    const auto placed = [&](const Room& room) {
      FloorRect r = room.lines;  // mirrored before it is rounded: else a mirrored plan would round otherwise
      if ((turn & 1) != 0) std::tie(r.x0, r.x1) = std::pair(outline.x1 - r.x1, outline.x1 - r.x0);
      if ((turn & 2) != 0) std::tie(r.y0, r.y1) = std::pair(outline.y1 - r.y1, outline.y1 - r.y0);
      const int x0 = halves(r.x0);
      const int x1 = halves(r.x1);
      const int y0 = halves(r.y0);
      const int y1 = halves(r.y1);
      if ((turn & 4) != 0) return std::array{y0, x0, y1, x1};
      return std::array{x0, y0, x1, y1};
    };
    std::vector<std::string> parts;
    const auto text_of = [&](int room) {
      const auto p = placed(rooms[static_cast<std::size_t>(room)]);
      return fmt::format("{},{},{},{}", p[0], p[1], p[2], p[3]);
    };
    for (std::size_t i = 0; i < rooms.size(); ++i) parts.push_back(text_of(static_cast<int>(i)));
    for (const Door& door : doors()) {
      const std::string a = text_of(door.opening->room_a);
      const std::string b = text_of(door.opening->room_b);
      parts.push_back(std::min(a, b) + "-" + std::max(a, b));
    }
    std::sort(parts.begin(), parts.end());
    std::string text;
    for (const std::string& part : parts) text += part + ";";
    if (best.empty() || text < best) best = text;
  }
  return best;
}

std::optional<FloorPlan> draw_floor_plan(Draw& draw) {
  FloorPlan plan;
  const int wanted = draw.between(2, 6);
  const double area = wanted * draw.uniform(10.5, 19.0);
  const double aspect = draw.uniform(1.0, 1.9);
  const double width = std::max(5.0, to_decimetre(std::sqrt(area * aspect)));
  const double depth = std::max(3.6, to_decimetre(area / width));
  const bool turned = draw.chance(0.5);
  plan.outline = {0.0, 0.0, turned ? depth : width, turned ? width : depth};
  plan.ceiling_m = to_decimetre(draw.uniform(2.4, 3.05));
  plan.rooms.push_back({"", RoomKind::kLiving, plan.outline});
  while (static_cast<int>(plan.rooms.size()) < wanted) {
    std::vector<std::size_t> possible;
    for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
      if (can_be_cut(plan.rooms[i].lines)) possible.push_back(i);
    }
    if (possible.empty()) return std::nullopt;
    cut(plan, possible[static_cast<std::size_t>(draw.below(static_cast<int>(possible.size())))], draw);
  }
  add_outer_walls(plan);
  const std::vector<Stretch> all = stretches(plan);
  if (!join_rooms(plan, all, draw)) return std::nullopt;
  add_windows(plan, all, draw);
  for (Wall& wall : plan.walls) {
    std::sort(wall.openings.begin(), wall.openings.end(),
              [](const Opening& a, const Opening& b) { return a.from < b.from; });
  }
  name_rooms(plan, draw);
  return plan;
}

}  // namespace cgsr::sim
