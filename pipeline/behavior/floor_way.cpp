#include "pipeline/behavior/floor_way.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace cgsr::behavior {
namespace {

constexpr double kMaxCells = 40000.0;
constexpr float kFar = std::numeric_limits<float>::max();
constexpr double kNear_m = 1.0;  // a goal, or the robot, may stand so far from the free floor

}  // namespace

FloorWay::FloorWay(const FreeFloor& floor, double cell_m)
    : cell_m_(std::max(cell_m, std::sqrt(floor.width_m() * floor.depth_m() / kMaxCells))),
      x_min_m_(floor.x_min_m()),
      y_min_m_(floor.y_min_m()),
      columns_(static_cast<std::int32_t>(floor.width_m() / cell_m_)),
      rows_(static_cast<std::int32_t>(floor.depth_m() / cell_m_)) {
  const auto cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  free_.resize(cells);
  way_.assign(cells, kFar);
  heap_.reserve(8 * cells);
  for (std::int32_t cell = 0; cell < columns_ * rows_; ++cell) {
    const Place place = middle_of(cell);
    free_[static_cast<std::size_t>(cell)] = floor.is_free(place.x_m, place.y_m) ? 1 : 0;
  }
}

Place FloorWay::middle_of(std::int32_t cell) const {
  const std::int32_t column = cell % columns_, row = cell / columns_;
  return {x_min_m_ + (column + 0.5) * cell_m_, y_min_m_ + (row + 0.5) * cell_m_};
}

std::int32_t FloorWay::cell_at(const Place& place) const {
  const double column = std::floor((place.x_m - x_min_m_) / cell_m_);
  const double row = std::floor((place.y_m - y_min_m_) / cell_m_);
  if (!(column >= 0.0 && row >= 0.0 && column < columns_ && row < rows_)) return -1;
  return static_cast<std::int32_t>(row) * columns_ + static_cast<std::int32_t>(column);
}

void FloorWay::block(const Place& place, double radius_m) {
  const auto reach = static_cast<int>(std::ceil(radius_m / cell_m_));
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const Place there{place.x_m + dx * cell_m_, place.y_m + dy * cell_m_};
      const std::int32_t cell = cell_at(there);
      if (cell >= 0 && distance_m(middle_of(cell), place) <= radius_m) free_[static_cast<std::size_t>(cell)] = 0;
    }
  }
}

void FloorWay::push(float way, std::int32_t cell) {
  if (heap_.size() == heap_.capacity()) return;  // never: a cell is reached from eight sides at most
  heap_.push_back({way, cell});
  std::ranges::push_heap(heap_, std::ranges::greater{}, &Entry::way);
}

template <class Fits>
std::int32_t FloorWay::nearest_cell(const Place& place, const Fits& fits) const {
  std::int32_t nearest = -1;
  double least_m = kNear_m;
  const auto reach = static_cast<int>(std::ceil(kNear_m / cell_m_));
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const std::int32_t cell = cell_at({place.x_m + dx * cell_m_, place.y_m + dy * cell_m_});
      if (cell < 0 || !fits(static_cast<std::size_t>(cell))) continue;
      const double away_m = distance_m(middle_of(cell), place);
      if (away_m < least_m) nearest = cell, least_m = away_m;
    }
  }
  return nearest;
}

bool FloorWay::begin(const Place& goal) {
  std::ranges::fill(way_, kFar);
  heap_.clear();
  const std::int32_t nearest = nearest_cell(goal, [this](std::size_t cell) { return free_[cell] != 0; });
  if (nearest < 0) return false;
  way_[static_cast<std::size_t>(nearest)] = 0.0F;
  push(0.0F, nearest);
  return true;
}

template <class Visit>
void FloorWay::for_each_neighbour(std::int32_t cell, const Visit& visit) const {
  const std::int32_t column = cell % columns_;
  const std::int32_t row = cell / columns_;
  for (std::int32_t dy = -1; dy <= 1; ++dy) {
    for (std::int32_t dx = -1; dx <= 1; ++dx) {
      if ((dx == 0 && dy == 0) || column + dx < 0 || column + dx >= columns_ || row + dy < 0 || row + dy >= rows_)
        continue;
      const std::int32_t next = cell + dy * columns_ + dx;
      if (free_[static_cast<std::size_t>(next)] == 0) continue;
      visit(next, dx != 0 && dy != 0 ? std::numbers::sqrt2_v<float> : 1.0F);
    }
  }
}

bool FloorWay::advance(int max_cells) {
  for (int settled = 0; settled < max_cells && !heap_.empty();) {
    const Entry entry = heap_.front();
    std::ranges::pop_heap(heap_, std::ranges::greater{}, &Entry::way);
    heap_.pop_back();
    if (entry.way > way_[static_cast<std::size_t>(entry.cell)]) continue;
    ++settled;
    for_each_neighbour(entry.cell, [&](std::int32_t next, float step) {
      if (entry.way + step >= way_[static_cast<std::size_t>(next)]) return;
      way_[static_cast<std::size_t>(next)] = entry.way + step;
      push(entry.way + step, next);
    });
  }
  return heap_.empty();
}

std::int32_t FloorWay::settled_near(const Place& place) const {
  const auto is_settled = [this](std::size_t cell) { return way_[cell] < kFar; };
  const std::int32_t here = cell_at(place);
  return here >= 0 && is_settled(static_cast<std::size_t>(here)) ? here : nearest_cell(place, is_settled);
}

double FloorWay::way_m(const Place& here) const {
  const std::int32_t cell = settled_near(here);
  return cell < 0 ? kInfinite_m : static_cast<double>(way_[static_cast<std::size_t>(cell)]) * cell_m_;
}

std::int32_t FloorWay::downhill(std::int32_t cell) const {
  std::int32_t best = cell;
  for_each_neighbour(cell, [&](std::int32_t next, float) {
    if (way_[static_cast<std::size_t>(next)] < way_[static_cast<std::size_t>(best)]) best = next;
  });
  return best;
}

bool FloorWay::is_clear(const Place& from, const Place& to) const {
  const double away_m = distance_m(from, to);
  const int steps = 1 + static_cast<int>(2.0 * away_m / cell_m_);
  for (int i = 1; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const std::int32_t cell = cell_at({from.x_m + t * (to.x_m - from.x_m), from.y_m + t * (to.y_m - from.y_m)});
    if (cell < 0 || free_[static_cast<std::size_t>(cell)] == 0) return false;
  }
  return true;
}

// The first cells may lie beside the free floor, as the robot may: the next one on the way is always taken.
std::optional<Place> FloorWay::ahead(const Place& here, double ahead_m) const {
  std::int32_t cell = settled_near(here);
  if (cell < 0) return std::nullopt;
  Place best = middle_of(cell);
  for (bool first = true;; first = false) {
    const std::int32_t next = downhill(cell);
    if (next == cell) return best;
    const Place place = middle_of(next);
    if (!first && (distance_m(here, place) > ahead_m || !is_clear(here, place))) return best;
    best = place;
    cell = next;
  }
}

}  // namespace cgsr::behavior
