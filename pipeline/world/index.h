#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/world/map.h"
#include "pipeline/world/tree.h"

namespace cgsr::world {

/// What a camera can see at all, as six planes in W.
struct Frustum {
  /// \param camera  with or without lens: everything that its image's pixels look at.
  /// \param near_m, far_m  along the optical axis.
  Frustum(const geometry::Pose& X_WC, const geometry::Camera& camera, double near_m, double far_m);

  Eigen::Matrix<float, 6, 3> normals;  ///< unit, pointing inwards: left, right, top, bottom, near, far.
  Eigen::Matrix<float, 6, 1> offsets;  ///< inside: normals * p >= offsets.
  Eigen::Vector3f eye;
  Eigen::Vector3f forward;  ///< the optical axis, unit.
};

/// Neighbours in space: positions [first, end) of Index::edge_order() or triangle_order().
struct Cell {
  std::uint32_t first = 0;
  std::uint32_t end = 0;
  float nearest_m = 0.0F;  ///< no item of it is nearer to the camera along the optical axis; never below 0.
  bool inside = false;     ///< all of it lies in the frustum: no item needs a test of its own.
};

struct Hit {
  float distance_m = 0.0F;
  std::uint32_t triangle = kNone;
  std::uint32_t surface = kNone;
};

/// Finds what of a map lies somewhere: two hierarchies of boxes, over triangles and over edges. Made once for a map, which outlives it and does
/// not change; no query allocates, and any number of threads may query it. Ours; boxes against the frustum as in (Assarsson and Moller 2000).
class Index {
 public:
  explicit Index(const Map& map);

  /// The cells whose boxes meet the frustum, roughly from near to far: nothing that is outside of all of them can be seen.
  /// \param cells  cleared and filled, never beyond its capacity.  \return false when there were more than fit: far ones are missing.
  bool edges_in(const Frustum& frustum, std::vector<Cell>& cells) const;
  bool triangles_in(const Frustum& frustum, std::vector<Cell>& cells) const;

  /// Ids of edges, so that those of a cell lie side by side. For a map from load_map() it is 0, 1, 2, ...
  [[nodiscard]] std::span<const std::uint32_t> edge_order() const { return edges_.order(); }
  /// The same of triangles.
  [[nodiscard]] std::span<const std::uint32_t> triangle_order() const { return triangles_.order(); }
  /// The surface of each triangle, by its id.
  [[nodiscard]] std::span<const std::uint32_t> surface_of_triangle() const { return surface_of_; }

  /// The first surface along a ray, from whichever side.
  /// \param direction  unit, W.  \param reach_m  no further.  \param skip  surfaces that are passed through.
  [[nodiscard]] std::optional<Hit> first_hit(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                                             float reach_m, std::span<const std::uint32_t> skip = {}) const;

  /// How far one may go along a ray before the map's first surface; reach_m when there is none.
  [[nodiscard]] float free_distance(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                                    float reach_m) const;

  /// The surface that a pixel shows; the distance is along the pixel's ray, not along the optical axis.
  [[nodiscard]] std::optional<Hit> at_pixel(const geometry::Pose& X_WC, const geometry::Camera& camera,
                                            const Eigen::Vector2d& pixel, float reach_m = 1e6F) const;

  /// What it takes in memory.
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] std::size_t nodes() const { return edges_.nodes().size() + triangles_.nodes().size(); }

 private:
  const Map* map_;
  Tree edges_;
  Tree triangles_;
  std::vector<std::uint32_t> surface_of_;
};

/// The hierarchies that an Index uses, for who wants to order a map's items in space beforehand.
Tree tree_of_edges(const Map& map);
Tree tree_of_triangles(const Map& map);

}  // namespace cgsr::world
