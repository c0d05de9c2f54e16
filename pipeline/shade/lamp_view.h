#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "pipeline/shade/shade_parameters.h"
#include "pipeline/world/map.h"

namespace cgsr::shade {

/// What a lamp's centre sees: six square faces around it, whose cells each name every triangle that may throw a shadow there, however thin. Whether
/// one stands between the lamp and a point is decided by the triangle itself, so that the size of the cells is a matter of cost alone.
/// This is a light buffer (Haines and Greenberg 1986); the dissertation (5.2) draws shadow volumes only. Points are in W, metres.
class LampView {
 public:
  /// \param map  outlives it.
  LampView(const world::Map& map, const ShadeParameters& parameters);

  /// Sorts the map's triangles into the cells, all at once. Allocates nothing.
  void place(const Eigen::Vector3f& p_WL);

  /// The same in steps: begin(), then go_on() until it says that all is sorted; questions may be asked from then on.
  void begin(const Eigen::Vector3f& p_WL);
  /// \param work  about so many cells or triangles are visited, a row of cells more at most. \return whether all is sorted.
  bool go_on(std::size_t work);

  static constexpr std::uint32_t kSeveral = 0xFFFFFFFEU;
  struct Answer {
    bool hidden = false;
    std::uint32_t seen = kSeveral;  ///< the only triangle in the point's cell.
  };

  /// \param own  the surface that the point lies on, which does not hide it; world::kNone: none.
  [[nodiscard]] Answer look_at(const Eigen::Vector3f& p_W, std::uint32_t own) const {
    return look_along(p_W - p_WL_, 1.0F, own);
  }
  /// The same of a point whose way from the lamp is known, `times` as long as it is (> 0).
  [[nodiscard]] Answer look_along(const Eigen::Vector3f& way, float times, std::uint32_t own) const;

  /// How many times as far as a point the lamp's ray through it goes until something stops it. \return infinity: nothing does.
  [[nodiscard]] float reach(const Eigen::Vector3f& p_W) const;

  /// Whether there were more triangles than cells could hold: some shadows may be missing.
  [[nodiscard]] bool full() const { return full_; }

 private:
  /// A triangle with the lamp at the origin: a ray from there meets it where side[i] . ray >= 0 for all i and nearness . ray > 0; it is then
  /// nearness . ray times as near as the ray is long.
  struct Seen {
    std::array<Eigen::Vector3f, 3> side;
    Eigen::Vector3f nearness;
    std::uint32_t surface;

    [[nodiscard]] float meets(const Eigen::Vector3f& ray) const {
      if (side[0].dot(ray) < 0.0F || side[1].dot(ray) < 0.0F || side[2].dot(ray) < 0.0F) return 0.0F;
      return nearness.dot(ray);
    }
  };
  struct Entry {
    std::uint32_t triangle = kNone;
    std::uint32_t next = kNone;  ///< entry of the same cell.
  };
  struct Outline;
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// What sorting does first, next and last; for each face, triangle after triangle, but for the first two.
  enum class Phase : std::uint8_t { kClear, kSee, kCover, kEnter, kDone };
  struct Progress {
    Phase phase = Phase::kDone;
    std::size_t face = 0;
    std::size_t next = 0;  ///< cell of kClear, surface of kSee, triangle of the others.
    int row = 0;           ///< of that triangle's outline: those above are done.
  };

  [[nodiscard]] std::uint32_t cell_of(const Eigen::Vector3f& ray) const;
  void enter_phase(Phase phase) { progress_ = {.phase = phase}; }
  std::size_t clear(std::size_t work);
  std::size_t see_surface();
  void see(std::uint32_t triangle, std::uint32_t surface);
  [[nodiscard]] bool outline(std::size_t face, std::uint32_t triangle, Outline& out) const;
  std::size_t lay_triangle(std::size_t work);
  [[nodiscard]] std::size_t cover_row(std::size_t face, const Outline& o, int y);
  [[nodiscard]] std::size_t enter_row(std::size_t face, std::uint32_t triangle, const Outline& o, int y);

  const world::Map& map_;
  float most_;  ///< nearness up to which a point counts as being on a surface, not behind it.
  float near_m_;
  int cells_;
  Eigen::Vector3f p_WL_ = Eigen::Vector3f::Zero();
  std::vector<Seen> seen_;  ///< [triangle]
  std::vector<float>
      covered_;  ///< [cell] of the six faces: 1/depth of the nearest triangle that covers all of it; 0: none does.
  std::vector<Entry> entries_;  ///< the first of each cell, then those that follow.
  std::size_t entries_used_ = 0;
  Progress progress_;
  bool placed_ = false;
  bool full_ = false;
};

}  // namespace cgsr::shade
