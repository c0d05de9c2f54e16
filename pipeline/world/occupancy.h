#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "pipeline/world/soup.h"
#include "platform/error.h"

namespace cgsr::world {

/// Which cells of the floor are occupied, as a laser maps them (ROS: nav_msgs/OccupancyGrid).
struct OccupancyGrid {
  int columns = 0;
  int rows = 0;
  double cell_m = 0.05;
  Eigen::Vector2d p_WO =
      Eigen::Vector2d::Zero();         ///< the corner of the grid that its columns and rows start from, [m] in W.
  double yaw_rad = 0.0;                ///< of its rows against W's x axis.
  std::vector<std::uint8_t> occupied;  ///< 1 or 0, row by row; the first row is the farthest from O, as in the image.
};

struct WallParameters {
  double height_m = 2.5;
  double tolerance_m = 0.05;  ///< by which a straight wall may leave the border of the occupied cells.
  double min_length_m = 0.3;  ///< a group of occupied cells is left out when the way once along it is shorter.
};

/// A vertical wall's foot on the floor.
struct Wall {
  Eigen::Vector2d p_WA = Eigen::Vector2d::Zero();  ///< [m] in W.
  Eigen::Vector2d p_WB = Eigen::Vector2d::Zero();
};

/// Walls, and how they compare with the cells that they were made of.
struct WallPlan {
  std::vector<Wall> walls;
  std::size_t border_cells = 0;  ///< occupied cells beside one that is not.
  double covered = 0.0;          ///< the share of them that lie within tolerance_m and a cell of a wall,
  double supported = 0.0;        ///< and the share of the walls' length that lies so near to an occupied cell.
  double length_m = 0.0;
};

/// Ours. Makes walls of the borders of occupied cells: the outlines of their groups and of the holes in them, as polygons (Douglas and Peucker 1973).
/// A wall that is a cell thin becomes one sheet where the tolerance allows it.
/// \return an error when there is no wall: no cell is occupied, or only groups shorter than min_length_m.
Result<WallPlan> walls_of(const OccupancyGrid& grid, const WallParameters& parameters);

/// The walls as upright rectangles from the floor to `height_m`, of one grey material whose colour is not known.
Soup soup_of(const WallPlan& plan, double height_m);

}  // namespace cgsr::world
