#pragma once

#include <optional>
#include <vector>

#include "hal/sim/generator/floor_plan.h"

namespace cgsr::sim {

/// A place on the floor, world frame [m].
struct FloorPoint {
  double x = 0.0;
  double y = 0.0;
};

/// A rectangle on the floor, turned about its middle.
struct Footprint {
  FloorPoint middle;
  double length_m = 0.0;  ///< along its heading.
  double width_m = 0.0;
  double heading_deg = 0.0;

  /// \return how far a place lies outside of it; 0 inside.
  [[nodiscard]] double distance_to(const FloorPoint& p) const;
  /// The rectangle along the world's axes around it.
  [[nodiscard]] FloorRect bounds() const;
};

Footprint footprint_of(const FloorRect& rect);

/// The floor of a home as a grid of cells of kCell_m, each with its distance to whatever stands nearest: where a robot can be, by a flood
/// fill, and how it gets from one place to another. Only for the generator; the vision plans nothing with it. Ours.
class FreeFloor {
 public:
  static constexpr double kCell_m = 0.05;
  static constexpr double kReach_m = 0.8;  ///< distances beyond this are not told apart.

  explicit FreeFloor(const FloorRect& outline);

  void add(const Footprint& obstacle);

  /// \return the distance from the middle of the cell at p to the nearest obstacle, at most kReach_m; 0 outside.
  [[nodiscard]] double clearance(const FloorPoint& p) const;
  [[nodiscard]] bool is_free(const FloorPoint& p, double radius_m) const { return clearance(p) >= radius_m; }

  /// \return for every cell, whether a disc of that radius gets there from `start`.
  [[nodiscard]] std::vector<bool> reached_from(const FloorPoint& start, double radius_m) const;

  /// \return corners of a way for a disc, `from` and `to` included, that keeps away from obstacles where it can; nothing: there is none.
  [[nodiscard]] std::optional<std::vector<FloorPoint>> way(const FloorPoint& from, const FloorPoint& to,
                                                           double radius_m) const;

  /// Is everything on the straight line free for a disc?
  [[nodiscard]] bool straight(const FloorPoint& from, const FloorPoint& to, double radius_m) const;

  [[nodiscard]] std::size_t cells() const { return clearance_.size(); }
  [[nodiscard]] FloorPoint middle_of(std::size_t cell) const;
  [[nodiscard]] std::size_t cell_at(const FloorPoint& p) const;  ///< the nearest one.

 private:
  [[nodiscard]] bool inside(int column, int row) const;

  FloorRect outline_;
  int columns_;
  int rows_;
  std::vector<float> clearance_;
};

}  // namespace cgsr::sim
