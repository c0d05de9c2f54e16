#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/behavior/free_floor.h"
#include "pipeline/behavior/place.h"

namespace cgsr::behavior {

/// Ways around walls and furniture to one goal: the length of the shortest way from every free cell of a grid (Dijkstra 1959, from the goal, eight
/// neighbours), worked out a few cells at a time.
/// Ours: Alg. 5.2 and 6.4.1.2 say nothing of the way.
///
/// Threads: one. Memory: 40,000 cells at most, 3 MB. Allocates at construction alone.
class FloorWay {
 public:
  static constexpr double kInfinite_m = 1e9;

  /// \param floor  where the robot may be.  \param cell_m  side of a cell, > 0; larger where the floor has too many.
  explicit FloorWay(const FreeFloor& floor, double cell_m = 0.10);

  /// Somebody stands there: from the next begin() on no way leads nearer than `radius_m`.
  void block(const Place& place, double radius_m);

  /// Begins with another goal, or with the free cell next to it within a metre.
  /// \return false: there is none, and no way either.
  bool begin(const Place& goal);

  /// \param max_cells  that are settled now: 0.5 million instructions for 1000.  \return whether all ways are known.
  bool advance(int max_cells);

  /// \return the length of the way from there to the goal; kInfinite_m: there is none, or it is not known yet.
  [[nodiscard]] double way_m(const Place& here) const;

  /// \return the farthest place on the way from `here` to the goal that is free in a straight line and no farther than `ahead_m`; nothing: there is no
  ///     way.
  [[nodiscard]] std::optional<Place> ahead(const Place& here, double ahead_m) const;

 private:
  struct Entry {
    float way;  // in cells
    std::int32_t cell;
  };

  [[nodiscard]] std::int32_t cell_at(const Place& place) const;
  template <class Fits>
  [[nodiscard]] std::int32_t nearest_cell(const Place& place, const Fits& fits) const;
  [[nodiscard]] std::int32_t settled_near(const Place& place) const;
  [[nodiscard]] Place middle_of(std::int32_t cell) const;
  [[nodiscard]] bool is_clear(const Place& from, const Place& to) const;
  [[nodiscard]] std::int32_t downhill(std::int32_t cell) const;
  template <class Visit>
  void for_each_neighbour(std::int32_t cell, const Visit& visit) const;
  void push(float way, std::int32_t cell);

  double cell_m_;
  double x_min_m_;
  double y_min_m_;
  std::int32_t columns_ = 0;
  std::int32_t rows_ = 0;
  std::vector<std::uint8_t> free_;
  std::vector<float> way_;  // from the goal, in cells
  std::vector<Entry> heap_;
};

}  // namespace cgsr::behavior
