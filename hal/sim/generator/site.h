#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hal/sim/generator/floor_plan.h"
#include "hal/sim/generator/free_floor.h"
#include "hal/sim/generator/makes.h"
#include "hal/sim/generator/palette.h"
#include "hal/sim/worlds/world_spec.h"

namespace cgsr::sim {

/// Half the width of the widest of the shipped robots and a margin [m]: a disc of this radius gets through every room.
inline constexpr double kRobotRadius_m = 0.35;

/// A side of a room, seen from inside.
enum class Side : std::uint8_t { kSouth, kNorth, kWest, kEast };
constexpr std::string_view to_string(Side side) {
  constexpr std::array<std::string_view, 4> kWords{"south", "north", "west", "east"};
  return kWords[static_cast<std::size_t>(side)];
}
inline constexpr std::array kSides{Side::kSouth, Side::kNorth, Side::kWest, Side::kEast};

/// Something that stands or hangs in the home.
struct Standing {
  Footprint footprint;
  double from_m = 0.0;  ///< above the floor.
  double to_m = 0.0;
};

/// A home while it is being built: what is there, and whether more fits. Ours.
class Site {
 public:
  Site(const FloorPlan& plan, WorldSpec& world, Palette palette);

  [[nodiscard]] const FloorPlan& plan() const { return *plan_; }
  [[nodiscard]] WorldSpec& world() { return *world_; }
  Palette& palette() { return palette_; }
  [[nodiscard]] const FreeFloor& floor() const { return floor_; }
  [[nodiscard]] const std::vector<Standing>& standing() const { return standing_; }

  /// Adds a shape of the building: no obstacle on the floor.
  void add(ShapeSpec shape) { world_->shape.push_back(std::move(shape)); }

  /// Puts a piece down at `middle`, `foot_m` above the floor, without asking whether it fits. \return its name.
  std::string put(const Make& make, const FloorPoint& middle, double heading_deg, double foot_m = 0.0);

  /// The same where it fits: inside the room, beside everything else, before no door, with a tall thing before no window, and so that a
  /// robot still gets everywhere. \return whether it was put.
  bool put_if_it_fits(const Make& make, const Room& room, const FloorPoint& middle, double heading_deg);

  /// Tries places along the room's walls. `gap_m` is left between wall and thing. \return the index in standing(); -1: no place.
  int put_at_wall(const Make& make, const Room& room, Draw& draw, double gap_m = 0.02);

  /// Keeps others away from a box of air: a lamp, a curtain.
  void reserve(const Standing& standing);

  /// Lets nothing be put on that floor.
  void keep_free(const FloorRect& floor) { before_doors_.push_back(floor); }

  /// Is there a wall without opening, curtain, picture or tall furniture between `from` and `to` along the side, at these heights?
  [[nodiscard]] bool bare(const Room& room, Side side, double from, double to, double low_m, double high_m) const;

  /// Is nothing within 20 cm of that place?
  [[nodiscard]] bool is_air(const FloorPoint& p, double height_m) const;

  /// Does a robot reach every door and a good part of every room? `with`: and one thing more.
  [[nodiscard]] bool drivable(const Standing* with = nullptr) const;

  /// \return a name that nothing else has: "chair 2".
  std::string fresh(const std::string& name);

 private:
  [[nodiscard]] bool free_of_others(const Standing& standing) const;

  const FloorPlan* plan_;
  WorldSpec* world_;
  Palette palette_;
  FreeFloor floor_;
  std::vector<Standing> standing_;
  std::vector<FloorRect> before_doors_;
  std::vector<FloorRect> before_windows_;
  std::vector<double> sills_m_;
  std::map<std::string, int> names_;
};

/// A place on a side of a room, `off_m` from the wall's face, and the heading of what stands there with its back to the wall.
struct AtWall {
  FloorPoint place;
  double heading_deg = 0.0;
};
AtWall at_wall(const Room& room, Side side, double along, double off_m);

/// \return the range of `along` on that side.
struct Range1 {
  double from = 0.0;
  double to = 0.0;
};
Range1 range_of(const Room& room, Side side);

/// \return the wall on that side.
const Wall* wall_on(const FloorPlan& plan, const Room& room, Side side);

}  // namespace cgsr::sim
