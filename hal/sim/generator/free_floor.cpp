#include "hal/sim/generator/free_floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <utility>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

constexpr std::array<std::pair<int, int>, 8> kNeighbours{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};
constexpr double kDiagonal = 1.4142135623730951;
constexpr double kComfort_m = 0.25;  // a way is dearer where less than this is left beside the disc

}  // namespace

double Footprint::distance_to(const FloorPoint& p) const {
  const double c = cosine(degrees(heading_deg));
  const double s = sine(degrees(heading_deg));
  const double dx = p.x - middle.x;
  const double dy = p.y - middle.y;
  const double out_x = std::max(0.0, std::abs(c * dx + s * dy) - length_m / 2.0);
  const double out_y = std::max(0.0, std::abs(c * dy - s * dx) - width_m / 2.0);
  return std::sqrt(out_x * out_x + out_y * out_y);
}

FloorRect Footprint::bounds() const {
  const double c = std::abs(cosine(degrees(heading_deg)));
  const double s = std::abs(sine(degrees(heading_deg)));
  const double half_x = (c * length_m + s * width_m) / 2.0;
  const double half_y = (s * length_m + c * width_m) / 2.0;
  return {middle.x - half_x, middle.y - half_y, middle.x + half_x, middle.y + half_y};
}

Footprint footprint_of(const FloorRect& rect) {
  return {{rect.x(), rect.y()}, rect.width(), rect.depth(), 0.0};
}

FreeFloor::FreeFloor(const FloorRect& outline)
    : outline_(outline),
      columns_(static_cast<int>(std::ceil(outline.width() / kCell_m))),
      rows_(static_cast<int>(std::ceil(outline.depth() / kCell_m))),
      clearance_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), static_cast<float>(kReach_m)) {}

bool FreeFloor::inside(int column, int row) const {
  return column >= 0 && row >= 0 && column < columns_ && row < rows_;
}

FloorPoint FreeFloor::middle_of(std::size_t cell) const {
  const std::size_t row = cell / static_cast<std::size_t>(columns_);
  const std::size_t column = cell % static_cast<std::size_t>(columns_);
  return {outline_.x0 + (static_cast<double>(column) + 0.5) * kCell_m,
          outline_.y0 + (static_cast<double>(row) + 0.5) * kCell_m};
}

std::size_t FreeFloor::cell_at(const FloorPoint& p) const {
  const int column = std::clamp(static_cast<int>(std::floor((p.x - outline_.x0) / kCell_m)), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(std::floor((p.y - outline_.y0) / kCell_m)), 0, rows_ - 1);
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
}

void FreeFloor::add(const Footprint& obstacle) {
  const FloorRect near = obstacle.bounds().inset(-kReach_m);
  const auto first_column = static_cast<int>(std::floor((near.x0 - outline_.x0) / kCell_m));
  const auto last_column = static_cast<int>(std::ceil((near.x1 - outline_.x0) / kCell_m));
  const auto first_row = static_cast<int>(std::floor((near.y0 - outline_.y0) / kCell_m));
  const auto last_row = static_cast<int>(std::ceil((near.y1 - outline_.y0) / kCell_m));
  for (int row = std::max(0, first_row); row <= std::min(rows_ - 1, last_row); ++row) {
    for (int column = std::max(0, first_column); column <= std::min(columns_ - 1, last_column); ++column) {
      const auto cell =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
      const auto distance = static_cast<float>(obstacle.distance_to(middle_of(cell)));
      clearance_[cell] = std::min(clearance_[cell], distance);
    }
  }
}

double FreeFloor::clearance(const FloorPoint& p) const {
  if (!outline_.contains(p.x, p.y)) return 0.0;
  return static_cast<double>(clearance_[cell_at(p)]);
}

std::vector<bool> FreeFloor::reached_from(const FloorPoint& start, double radius_m) const {
  std::vector<bool> reached(clearance_.size(), false);
  const auto radius = static_cast<float>(radius_m);
  std::vector<std::size_t> open;
  if (clearance_[cell_at(start)] >= radius) {
    open.push_back(cell_at(start));
    reached[open.back()] = true;
  }
  while (!open.empty()) {
    const std::size_t cell = open.back();
    open.pop_back();
    const int column = static_cast<int>(cell % static_cast<std::size_t>(columns_));
    const int row = static_cast<int>(cell / static_cast<std::size_t>(columns_));
    for (std::size_t i = 0; i < 4; ++i) {
      const auto [dx, dy] = kNeighbours[i];
      if (!inside(column + dx, row + dy)) continue;
      const std::size_t next = static_cast<std::size_t>(row + dy) * static_cast<std::size_t>(columns_) +
                               static_cast<std::size_t>(column + dx);
      if (reached[next] || clearance_[next] < radius) continue;
      reached[next] = true;
      open.push_back(next);
    }
  }
  return reached;
}

bool FreeFloor::straight(const FloorPoint& from, const FloorPoint& to, double radius_m) const {
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const int steps = 1 + static_cast<int>(std::sqrt(dx * dx + dy * dy) / (kCell_m / 2.0));
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    if (!is_free({from.x + t * dx, from.y + t * dy}, radius_m)) return false;
  }
  return true;
}

std::optional<std::vector<FloorPoint>> FreeFloor::way(const FloorPoint& from, const FloorPoint& to,
                                                      double radius_m) const {
  constexpr double kFar = std::numeric_limits<double>::max();
  const std::size_t start = cell_at(from);
  const std::size_t goal = cell_at(to);
  std::vector<double> cost(clearance_.size(), kFar);
  std::vector<std::size_t> before(clearance_.size(), start);
  using Entry = std::pair<double, std::size_t>;  // equal costs: the lower cell, so that the way is the same everywhere
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  if (!is_free(from, radius_m)) return std::nullopt;
  cost[start] = 0.0;
  open.emplace(0.0, start);
  while (!open.empty() && open.top().second != goal) {
    const auto [so_far, cell] = open.top();
    open.pop();
    if (so_far > cost[cell]) continue;
    const int column = static_cast<int>(cell % static_cast<std::size_t>(columns_));
    const int row = static_cast<int>(cell / static_cast<std::size_t>(columns_));
    for (const auto& [dx, dy] : kNeighbours) {
      if (!inside(column + dx, row + dy)) continue;
      const std::size_t next = static_cast<std::size_t>(row + dy) * static_cast<std::size_t>(columns_) +
                               static_cast<std::size_t>(column + dx);
      const double room = static_cast<double>(clearance_[next]) - radius_m;
      if (room < 0.0) continue;
      const double dear = 1.0 + 4.0 * std::max(0.0, kComfort_m - room) / kComfort_m;
      const double sum = so_far + dear * (dx != 0 && dy != 0 ? kDiagonal : 1.0);
      if (sum >= cost[next]) continue;
      cost[next] = sum;
      before[next] = cell;
      open.emplace(sum, next);
    }
  }
  if (cost[goal] == kFar) return std::nullopt;
  std::vector<FloorPoint> cells{to};
  for (std::size_t cell = before[goal]; cell != start; cell = before[cell]) cells.push_back(middle_of(cell));
  if (goal != start) cells.push_back(from);
  std::reverse(cells.begin(), cells.end());
  // Straight where nothing is in the way, with as much room as the way itself leaves, up to the comfort.
  std::vector<FloorPoint> corners{cells.front()};
  for (std::size_t at = 0; at + 1 < cells.size();) {
    std::size_t next = at + 1;
    double room = kComfort_m;
    for (std::size_t i = at + 1; i < cells.size(); ++i) {
      room = std::min(room, clearance(cells[i]) - radius_m);
      if (straight(cells[at], cells[i], radius_m + std::max(0.0, 0.7 * room))) next = i;
    }
    corners.push_back(cells[next]);
    at = next;
  }
  return corners;
}

}  // namespace cgsr::sim
