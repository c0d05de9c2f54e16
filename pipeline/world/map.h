#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace cgsr::world {

inline constexpr std::uint32_t kNone = 0xFFFFFFFFU;

/// What a surface is made of, as far as a robot's map says it.
struct Material {
  std::string name;
  Eigen::Vector3f color = Eigen::Vector3f::Constant(0.5F);  ///< mean colour, sRGB-encoded, 0..1.
  bool known_color = true;                                  ///< false: the file did not say; nothing is expected of it.
};

/// A part of a plane of one material: what is left after coplanar neighbours were joined. Seen from both sides.
struct Surface {
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  std::uint32_t material = 0;
  Eigen::Vector3f normal =
      Eigen::Vector3f::UnitZ();  ///< unit; n . p = offset_m on the surface. Outlines run counter-clockwise about it.
  float offset_m = 0.0F;
};

/// Indices into Map::vertices, counter-clockwise about the surface's normal.
using Triangle = std::array<std::uint32_t, 3>;

enum class EdgeKind : std::uint8_t {
  kCrease,    ///< two surfaces meet at an angle.
  kBorder,    ///< one surface ends.
  kMaterial,  ///< two coplanar surfaces of different materials meet.
  kDrawn,     ///< a line of the file's own (ViSP's .cao).
};

/// A straight line of the map, once; its index in Map::edges is its id.
///
/// Looked at with vertices[0] below and vertices[1] above and surface[0]'s front facing the viewer, surface[0] lies to the left. kNone: nothing of the map is there.
struct Edge {
  std::array<std::uint32_t, 2> vertices{};
  std::array<std::uint32_t, 2> surfaces{kNone, kNone};
  EdgeKind kind = EdgeKind::kCrease;
  float contrast =
      0.0F;  ///< |difference of luma| expected between its two sides, 0..1; a border's: against the surface that it lies on or 0.25 when there is none.
};

/// The static geometry that the robot knows, in W, metres, z up. Plain arrays: made once by the loader, never changed after.
struct Map {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Triangle> triangles;  ///< those of a surface lie together.
  std::vector<Surface> surfaces;
  std::vector<Edge> edges;
  std::vector<Material> materials;
};

}  // namespace cgsr::world
