#include "hal/sim/generator/route.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

constexpr double kDoorstep_m = 0.55;
constexpr double kSamePlace_m = 0.12;
constexpr double kRoomy_m = 0.6;

double distance(const FloorPoint& a, const FloorPoint& b) {
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
}

/// Through all rooms, depth first.
class Walk {
 public:
  Walk(const Site& site, Draw& draw) : site_(site), draw_(draw), seen_(site.plan().rooms.size(), false) {}

  void visit(int room) {
    seen_[static_cast<std::size_t>(room)] = true;
    const FloorPoint here = place_in(room);
    stops_.push_back(here);
    for (const FloorPlan::Door& door : site_.plan().doors()) {
      const bool forth = door.opening->room_a == room;
      if (!forth && door.opening->room_b != room) continue;
      const int next = forth ? door.opening->room_b : door.opening->room_a;
      if (seen_[static_cast<std::size_t>(next)]) continue;
      cross(door, forth);
      visit(next);
      cross(door, !forth);
      stops_.push_back(here);
    }
  }

  [[nodiscard]] const std::vector<FloorPoint>& stops() const { return stops_; }

 private:
  /// From the room before a wall (at less x or y) to the one behind it, or back.
  void cross(const FloorPlan::Door& door, bool forth) {
    const double along = (door.opening->from + door.opening->to) / 2.0;
    for (const double off : {-kDoorstep_m, kDoorstep_m}) {
      const double at = door.wall->at + (forth ? off : -off);
      stops_.push_back(door.wall->along_x ? FloorPoint{rounded(along), rounded(at)}
                                          : FloorPoint{rounded(at), rounded(along)});
    }
  }

  /// Anywhere in the room where there is room to turn.
  FloorPoint place_in(int room) {
    const FreeFloor& floor = site_.floor();
    const FloorRect rect = site_.plan().rooms[static_cast<std::size_t>(room)].floor();
    const FloorPlan::Door door = site_.plan().doors().front();
    const double along = (door.opening->from + door.opening->to) / 2.0;
    const std::vector<bool> reached = floor.reached_from(
        door.wall->along_x ? FloorPoint{along, door.wall->at} : FloorPoint{door.wall->at, along}, kRobotRadius_m);
    std::vector<std::size_t> cells;
    double best = 0.0;
    for (std::size_t cell = 0; cell < floor.cells(); ++cell) {
      const FloorPoint p = floor.middle_of(cell);
      if (!reached[cell] || !rect.contains(p.x, p.y)) continue;
      cells.push_back(cell);
      best = std::max(best, floor.clearance(p));
    }
    const double enough = std::min(kRoomy_m, best - 0.03);
    std::erase_if(cells, [&](std::size_t cell) { return floor.clearance(floor.middle_of(cell)) < enough; });
    if (cells.empty()) return {rect.x(), rect.y()};
    const FloorPoint p = floor.middle_of(cells[static_cast<std::size_t>(draw_.below(static_cast<int>(cells.size())))]);
    return {rounded(p.x), rounded(p.y)};
  }

  const Site& site_;
  Draw& draw_;
  std::vector<bool> seen_;
  std::vector<FloorPoint> stops_;
};

}  // namespace

std::optional<Route> draw_route(const Site& site, Draw& draw) {
  Walk walk(site, draw);
  walk.visit(draw.below(static_cast<int>(site.plan().rooms.size())));
  Route route;
  route.start = walk.stops().front();
  FloorPoint at = route.start;
  for (std::size_t i = 1; i < walk.stops().size(); ++i) {
    const FloorPoint& stop = walk.stops()[i];
    std::vector<FloorPoint> corners{at, stop};
    if (!site.floor().straight(at, stop, kRobotRadius_m)) {
      const auto found = site.floor().way(at, stop, kRobotRadius_m);
      if (!found) return std::nullopt;
      corners = *found;
    }
    for (std::size_t k = 1; k < corners.size(); ++k) {
      const FloorPoint next{rounded(corners[k].x), rounded(corners[k].y)};
      const bool last = k + 1 == corners.size();
      if (!last && distance(at, next) < kSamePlace_m) continue;
      route.length_m += distance(at, next);
      route.places.push_back(next);
      at = next;
    }
  }
  if (route.places.empty()) return std::nullopt;
  const FloorPoint& first = route.places.front();
  const double heading = arc_tangent(first.y - route.start.y, first.x - route.start.x) * 180.0 / kPi;
  route.start_heading_deg = std::round(heading * 10.0) / 10.0;
  return route;
}

}  // namespace cgsr::sim
