#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace cgsr::sim {

/// A rigid motion; `X_AB` takes coordinates in B to coordinates in A.
using Pose = Eigen::Isometry3d;

/// A surface of polygons, already cut into triangles for the tracer.
///
/// Polygons are what a map would call a surface: flat faces with their outline. Triangles know their polygon. Corners are not shared
/// between polygons unless the mesh is smooth: a corner's normal is the polygon's own.
struct Mesh {
  struct Triangle {
    std::array<std::uint32_t, 3> corner;  ///< counter-clockwise seen from outside.
    std::uint32_t polygon;
  };

  std::vector<Eigen::Vector3f> position_m;
  std::vector<Eigen::Vector3f> normal;  ///< unit, one per corner; for light, not for geometry.
  std::vector<Eigen::Vector2f> uv;      ///< surface coordinates: metres for patterns, 0..1 for textures.
  std::vector<Triangle> triangles;
  std::vector<std::vector<std::uint32_t>> polygons;  ///< outlines as corner indices, counter-clockwise.
  bool smooth = false;                               ///< corner normals stand for a curved surface.

  /// Appends `other` as it is.
  void append(const Mesh& other);

  /// Moves every corner by X_AB: a mesh given in B is then in A. Mirrors and scales are not rigid and not allowed.
  void transform(const Pose& X_AB);

  /// Appends a flat convex polygon with the normal that its order implies. `uv` has as many entries as `corners_m`.
  void add_polygon(const std::vector<Eigen::Vector3f>& corners_m, const std::vector<Eigen::Vector2f>& uv_of_corners);

  /// Replaces the normals of a curved surface by the area-weighted mean of the triangles around each corner.
  void smooth_normals();
};

/// Both ends of the box around every corner [m]; an empty mesh gives an empty box.
Eigen::AlignedBox3f bounds(const Mesh& mesh);

}  // namespace cgsr::sim
