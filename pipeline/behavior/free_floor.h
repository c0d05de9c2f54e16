#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/world/map.h"
#include "platform/parameters.h"

namespace cgsr::behavior {

/// What is an obstacle, and how far the robot keeps from it.
struct FreeFloorParameters {
  double min_clearance_m = 0.40;
  double min_obstacle_height_m = 0.03;
  double max_obstacle_height_m = 1.35;
  double cell_m = 0.05;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("min_clearance_m", self.min_clearance_m, {0.0, 3.0}, "m",
                 "The smallest distance from the robot's centre to any obstacle in the map.");
    visit.number("min_obstacle_height_m", self.min_obstacle_height_m, {0.0, 1.0}, "m",
                 "Lower surfaces are not obstacles, because the robot can drive over them.");
    visit.number("max_obstacle_height_m", self.max_obstacle_height_m, {0.1, 5.0}, "m",
                 "Higher surfaces are not obstacles, because the robot can drive under them.");
    visit.number("cell_m", self.cell_m, {0.01, 0.5}, "m",
                 "The cell size of the grid in which the free floor is computed.");
  }
};

/// Where on the floor a robot may be by its map, as a grid that is worked out once. What the map does not hold is not kept clear of: the robot
/// has no obstacle sensor. Outside of the map nothing is free. Places are in the world frame, headings count from its x axis to the left.
/// Ours: Alg. 5.2, lines 3 and 10, says nothing of the way. Obstacles grow by the clearance, so that the robot is a point (Lozano-Perez 1983).
///
/// Threads: any number may ask. No query allocates.
class FreeFloor {
 public:
  FreeFloor(const world::Map& map, const FreeFloorParameters& parameters);

  [[nodiscard]] bool is_free(double x_m, double y_m) const;

  /// The rectangle that the map covers: its corner with the least coordinates, and its sides; empty: no map.
  [[nodiscard]] double x_min_m() const { return x_min_m_; }
  [[nodiscard]] double y_min_m() const { return y_min_m_; }
  [[nodiscard]] double width_m() const { return columns_ * parameters_.cell_m; }
  [[nodiscard]] double depth_m() const { return rows_ * parameters_.cell_m; }

  /// How far one can go from a place straight along a heading, at most `longest_m`; 0 when the place itself is not free.
  [[nodiscard]] double way_m(double x_m, double y_m, double heading_rad, double longest_m) const;

 private:
  void block(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c);
  void grow();

  FreeFloorParameters parameters_;
  double x_min_m_ = 0.0;
  double y_min_m_ = 0.0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint8_t> blocked_;
};

}  // namespace cgsr::behavior
