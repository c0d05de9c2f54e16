#include "pipeline/behavior/lookouts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "pipeline/behavior/floor_way.h"

namespace cgsr::behavior {
namespace {

constexpr double kLookoutRaster_m = 0.3;
constexpr double kStandingRaster_m = 0.25;
constexpr double kShoulder_m = 0.25;  // half of somebody's width
constexpr double kFaceFrom_m = 1.2, kFaceTo_m = 1.7;

std::vector<Place> raster(const FreeFloor& floor, double step_m) {
  std::vector<Place> places;
  for (double y = floor.y_min_m() + step_m / 2; y < floor.y_min_m() + floor.depth_m(); y += step_m) {
    for (double x = floor.x_min_m() + step_m / 2; x < floor.x_min_m() + floor.width_m(); x += step_m) {
      if (floor.is_free(x, y)) places.push_back({x, y});
    }
  }
  return places;
}

bool sees(const FreeFloor& air, const Place& from, const Place& to, const LookoutParameters& parameters) {
  const double away_m = distance_m(from, to);
  if (away_m < parameters.min_distance_m || away_m > parameters.max_distance_m) return false;
  const double heading_rad = std::atan2(to.y_m - from.y_m, to.x_m - from.x_m);
  return air.way_m(from.x_m, from.y_m, heading_rad, away_m) >= away_m;
}

/// What each place sees: indices of standing places.
using Views = std::vector<std::vector<std::size_t>>;

Views views_of(const std::vector<Place>& lookouts, const std::vector<Place>& standing, const FreeFloor& air,
               const LookoutParameters& parameters) {
  Views views(lookouts.size());
  for (std::size_t i = 0; i < lookouts.size(); ++i) {
    for (std::size_t k = 0; k < standing.size(); ++k) {
      if (sees(air, lookouts[i], standing[k], parameters)) views[i].push_back(k);
    }
  }
  return views;
}

/// \return indices of lookouts, and what share of all that can be seen they see.
std::pair<std::vector<std::size_t>, double> cover(const Views& views, std::size_t standing, double max_unseen_share) {
  std::vector<char> seen(standing, 0), visible(standing, 0);
  for (const auto& view : views) {
    for (const std::size_t k : view) visible[k] = 1;
  }
  const auto all = static_cast<double>(std::ranges::count(visible, 1));
  std::vector<std::size_t> chosen;
  double count = 0.0;
  while (count < (1.0 - max_unseen_share) * all && chosen.size() < LookoutPlan::kMaxLookouts) {
    std::size_t best = 0;
    std::ptrdiff_t most = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const auto gain = std::ranges::count_if(views[i], [&](std::size_t k) { return seen[k] == 0; });
      if (gain > most) best = i, most = gain;
    }
    if (most == 0) break;
    for (const std::size_t k : views[best]) seen[k] = 1;
    count += static_cast<double>(most);
    chosen.push_back(best);
  }
  return {chosen, all > 0.0 ? count / all : 0.0};
}

/// Lengths of the ways between places: row and column 0 are the start.
using Ways = std::vector<std::vector<double>>;

Ways ways_between(FloorWay& way, const std::vector<Place>& places) {
  Ways ways(places.size(), std::vector<double>(places.size(), FloorWay::kInfinite_m));
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!way.begin(places[i])) continue;
    way.advance(std::numeric_limits<int>::max());
    for (std::size_t k = 0; k < places.size(); ++k) ways[i][k] = way.way_m(places[k]);
  }
  return ways;
}

std::vector<std::size_t> nearest_first(const Ways& ways) {
  std::vector<std::size_t> tour{0};
  while (tour.size() < ways.size()) {
    std::size_t next = 0;
    for (std::size_t k = 1; k < ways.size(); ++k) {
      if (std::ranges::find(tour, k) != tour.end()) continue;
      if (next == 0 || ways[tour.back()][k] < ways[tour.back()][next]) next = k;
    }
    tour.push_back(next);
  }
  return tour;
}

/// Reverses parts of the tour as long as that shortens it; it ends anywhere.
void shorten(const Ways& ways, std::vector<std::size_t>& tour) {
  for (bool better = true; better;) {
    better = false;
    for (std::size_t i = 1; i + 1 < tour.size(); ++i) {
      for (std::size_t k = i + 1; k < tour.size(); ++k) {
        const bool last = k + 1 == tour.size();
        const double before = ways[tour[i - 1]][tour[i]] + (last ? 0.0 : ways[tour[k]][tour[k + 1]]);
        const double after = ways[tour[i - 1]][tour[k]] + (last ? 0.0 : ways[tour[i]][tour[k + 1]]);
        if (after > before - 1e-6) continue;
        std::reverse(tour.begin() + static_cast<std::ptrdiff_t>(i), tour.begin() + static_cast<std::ptrdiff_t>(k) + 1);
        better = true;
      }
    }
  }
}

}  // namespace

LookoutPlan plan_lookouts(const world::Map& map, const Place& start, const LookoutParameters& parameters) {
  const FreeFloor floor(map, parameters.floor);
  FreeFloorParameters hides{0.0, kFaceFrom_m, kFaceTo_m, parameters.floor.cell_m};
  const FreeFloor air(map, hides);
  FreeFloorParameters stands = parameters.floor;
  stands.min_clearance_m = kShoulder_m;
  FloorWay way(floor);
  if (!way.begin(start)) return {};
  way.advance(std::numeric_limits<int>::max());
  std::vector<Place> reachable = raster(floor, kLookoutRaster_m);
  std::erase_if(reachable, [&](const Place& place) { return way.way_m(place) >= FloorWay::kInfinite_m; });
  const std::vector<Place> standing = raster(FreeFloor(map, stands), kStandingRaster_m);
  const auto [chosen, seen_share] =
      cover(views_of(reachable, standing, air, parameters), standing.size(), parameters.max_unseen_share);
  std::vector<Place> places{start};
  for (const std::size_t i : chosen) places.push_back(reachable[i]);
  const Ways ways = ways_between(way, places);
  std::vector<std::size_t> tour = nearest_first(ways);
  shorten(ways, tour);
  LookoutPlan plan;
  plan.seen_share = seen_share;
  for (const std::size_t i : tour) {
    if (i != 0) plan.lookouts.push_back(places[i]);
  }
  return plan;
}

}  // namespace cgsr::behavior
