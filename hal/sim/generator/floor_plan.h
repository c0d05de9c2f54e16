#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/sim/generator/draw.h"

namespace cgsr::sim {

/// A rectangle on the floor along the world's axes [m].
struct FloorRect {
  double x0 = 0.0;
  double y0 = 0.0;
  double x1 = 0.0;
  double y1 = 0.0;

  [[nodiscard]] double width() const { return x1 - x0; }
  [[nodiscard]] double depth() const { return y1 - y0; }
  [[nodiscard]] double area() const { return width() * depth(); }
  [[nodiscard]] double x() const { return (x0 + x1) / 2.0; }
  [[nodiscard]] double y() const { return (y0 + y1) / 2.0; }
  /// The same, smaller by so much on every side.
  [[nodiscard]] FloorRect inset(double by) const { return {x0 + by, y0 + by, x1 - by, y1 - by}; }
  [[nodiscard]] bool overlaps(const FloorRect& other) const {
    return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
  }
  [[nodiscard]] bool contains(double px, double py) const { return px >= x0 && px <= x1 && py >= y0 && py <= y1; }
};

enum class RoomKind : std::uint8_t { kLiving, kKitchen, kBedroom, kStudy, kHall, kBath };
constexpr std::string_view to_string(RoomKind kind) {
  constexpr std::array<std::string_view, 6> kWords{"living room", "kitchen", "bedroom", "study", "hall", "bath"};
  return kWords[static_cast<std::size_t>(kind)];
}

struct Room {
  std::string name;
  RoomKind kind = RoomKind::kLiving;
  FloorRect lines;  ///< its walls' middle lines.

  /// The floor between its walls.
  [[nodiscard]] FloorRect floor() const;
};

enum class OpeningKind : std::uint8_t { kDoor, kPassage, kWindow };
constexpr std::string_view to_string(OpeningKind kind) {
  constexpr std::array<std::string_view, 3> kWords{"door", "passage", "window"};
  return kWords[static_cast<std::size_t>(kind)];
}

/// A hole in a wall. `from` and `to` run along the wall [m]; what can be driven through lies between them.
struct Opening {
  OpeningKind kind = OpeningKind::kDoor;
  double from = 0.0;
  double to = 0.0;
  double sill_m = 0.0;
  double head_m = 2.05;
  int room_a = 0;
  int room_b = -1;  ///< -1: outside.
};

/// A straight wall as thick as kWall_m along its middle line: y = at (along_x) or x = at.
struct Wall {
  bool along_x = true;
  double at = 0.0;
  double from = 0.0;
  double to = 0.0;
  bool outer = false;
  std::vector<Opening> openings;
};

inline constexpr double kWall_m = 0.1;
inline constexpr double kMinDoor_m = 0.8;  ///< what every door and passage leaves free at least.

/// Rooms, the walls between them, and how one gets from one to the other. Ours.
struct FloorPlan {
  FloorRect outline;  ///< the outer walls' middle lines; its lower left corner is the world's origin.
  double ceiling_m = 2.6;
  std::vector<Room> rooms;
  std::vector<Wall> walls;

  /// \return the openings that can be driven through, with their walls.
  struct Door {
    const Wall* wall;
    const Opening* opening;
  };
  [[nodiscard]] std::vector<Door> doors() const;

  /// The graph of rooms and doors in a form that does not depend on how the rooms are numbered: "4:0-1,0-2,0-3".
  [[nodiscard]] std::string door_graph() const;

  /// The plan itself: rooms to half a metre and which of them are joined, the same for a plan that is turned or mirrored.
  [[nodiscard]] std::string layout() const;

  /// \return the room at a place; -1: none.
  [[nodiscard]] int room_at(double x, double y) const;
};

/// Draws two to six rooms by cutting a rectangle, joined by doors so that every room can be reached, and windows in the outer walls.
/// \return nothing when the cuts left rooms that no door fits between: draw again.
std::optional<FloorPlan> draw_floor_plan(Draw& draw);

}  // namespace cgsr::sim
