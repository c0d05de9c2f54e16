#include "pipeline/behavior/free_floor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

namespace cgsr::behavior {
namespace {

constexpr double kMostCells = 4e6;

}  // namespace

FreeFloor::FreeFloor(const world::Map& map, const FreeFloorParameters& parameters) : parameters_(parameters) {
  Eigen::AlignedBox3f box;
  for (const auto& vertex : map.vertices) box.extend(vertex);
  if (map.vertices.empty()) return;
  const double width = static_cast<double>(box.sizes().x());
  const double depth = static_cast<double>(box.sizes().y());
  parameters_.cell_m = std::max(parameters_.cell_m, std::sqrt(width * depth / kMostCells));
  x_min_m_ = static_cast<double>(box.min().x());
  y_min_m_ = static_cast<double>(box.min().y());
  columns_ = static_cast<int>(width / parameters_.cell_m) + 1;
  rows_ = static_cast<int>(depth / parameters_.cell_m) + 1;
  blocked_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
  for (const auto& triangle : map.triangles) {
    block(map.vertices[triangle[0]], map.vertices[triangle[1]], map.vertices[triangle[2]]);
  }
  grow();
}

void FreeFloor::block(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const float lowest = std::min({a.z(), b.z(), c.z()});
  const float tallest = std::max({a.z(), b.z(), c.z()});
  if (static_cast<double>(tallest) < parameters_.min_obstacle_height_m ||
      static_cast<double>(lowest) > parameters_.max_obstacle_height_m)
    return;
  // Points of the triangle, no further apart than half a cell.
  const double longest = static_cast<double>(std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()}));
  const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * longest / parameters_.cell_m)));
  for (int i = 0; i <= steps; ++i) {
    for (int k = 0; k <= steps - i; ++k) {
      const auto u = static_cast<float>(i) / static_cast<float>(steps);
      const auto v = static_cast<float>(k) / static_cast<float>(steps);
      const Eigen::Vector3f p = a + u * (b - a) + v * (c - a);
      const auto z = static_cast<double>(p.z());
      if (z < parameters_.min_obstacle_height_m || z > parameters_.max_obstacle_height_m) continue;
      const auto column = static_cast<int>((static_cast<double>(p.x()) - x_min_m_) / parameters_.cell_m);
      const auto row = static_cast<int>((static_cast<double>(p.y()) - y_min_m_) / parameters_.cell_m);
      if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
      blocked_[static_cast<std::size_t>(row * columns_ + column)] = 1;
    }
  }
}

/// Keeps the robot's middle clear of what is blocked.
void FreeFloor::grow() {
  const std::vector<std::uint8_t> things = blocked_;
  const auto reach = static_cast<int>(std::ceil(parameters_.min_clearance_m / parameters_.cell_m));
  const double reach2 =
      parameters_.min_clearance_m * parameters_.min_clearance_m / (parameters_.cell_m * parameters_.cell_m);
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      if (things[static_cast<std::size_t>(row * columns_ + column)] == 0) continue;
      for (int y = std::max(0, row - reach); y <= std::min(rows_ - 1, row + reach); ++y) {
        for (int x = std::max(0, column - reach); x <= std::min(columns_ - 1, column + reach); ++x) {
          const int dx = x - column;
          const int dy = y - row;
          if (dx * dx + dy * dy <= reach2) blocked_[static_cast<std::size_t>(y * columns_ + x)] = 1;
        }
      }
    }
  }
}

bool FreeFloor::is_free(double x_m, double y_m) const {
  const double column = std::floor((x_m - x_min_m_) / parameters_.cell_m);
  const double row = std::floor((y_m - y_min_m_) / parameters_.cell_m);
  if (!(column >= 0.0 && row >= 0.0 && column < columns_ && row < rows_)) return false;
  return blocked_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(column)] == 0;
}

double FreeFloor::way_m(double x_m, double y_m, double heading_rad, double longest_m) const {
  const double step = 0.5 * parameters_.cell_m;
  const double dx = std::cos(heading_rad);
  const double dy = std::sin(heading_rad);
  double free = 0.0;
  for (double way = 0.0; way < longest_m + step; way += step) {
    const double at = std::min(way, longest_m);
    if (!is_free(x_m + at * dx, y_m + at * dy)) return free;
    free = at;
  }
  return free;
}

}  // namespace cgsr::behavior
