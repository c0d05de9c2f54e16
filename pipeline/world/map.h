#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
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

/// A part of a plane of one material: what is left after coplanar neighbours were joined. Seen from both sides where the file does not say otherwise.
struct Surface {
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  std::uint32_t material = 0;
  Eigen::Vector3f normal =
      Eigen::Vector3f::UnitZ();  ///< unit; n . p = offset_m on the surface. Outlines run counter-clockwise about it.
  float offset_m = 0.0F;
  bool one_sided = false;  ///< neither seen nor hiding anything from behind, as the faces of ViSP's .cao.
};

/// Indices into Map::vertices, counter-clockwise about the surface's normal.
using Triangle = std::array<std::uint32_t, 3>;

enum class EdgeKind : std::uint8_t {
  kCrease,    ///< two surfaces meet at an angle.
  kBorder,    ///< one surface ends.
  kMaterial,  ///< two coplanar surfaces of different materials meet.
  kDrawn,     ///< a line of the file's own (ViSP's .cao); no surfaces.
};
constexpr std::string_view to_string(EdgeKind kind) {
  switch (kind) {
    case EdgeKind::kCrease:
      return "crease";
    case EdgeKind::kBorder:
      return "border";
    case EdgeKind::kMaterial:
      return "material";
    case EdgeKind::kDrawn:
      return "drawn";
  }
  return "";
}

/// A straight line of the map, once; its index in Map::edges is its id.
///
/// Looked at with vertices[0] below and vertices[1] above and surfaces[0]'s front facing the viewer, surfaces[0] lies to the left and
/// surfaces[1] to the right; who looks at surfaces[0]'s back sees them swapped. kNone: nothing of the map is there.
struct Edge {
  std::array<std::uint32_t, 2> vertices{};
  std::array<std::uint32_t, 2> surfaces{kNone, kNone};
  /// What is seen beside the edge, left and right as above: the adjacent surface itself, or the one that covers it or that it lies on (within
  /// LoadOptions::lies_on_m): a poster's border has {poster, wall}, a box's foot {side, floor}, though the mesh says {side, bottom}.
  /// kNone: whatever is behind.
  std::array<std::uint32_t, 2> sides{kNone, kNone};
  EdgeKind kind = EdgeKind::kCrease;
  /// |difference of luma| expected between its two sides, 0..1: that of their colours and, where they differ in direction, of their shading.
  /// 0.25 where a side or its colour is not known.
  float contrast = 0.0F;
};

/// \return whether a surface is seen from a place in W.
inline bool is_seen_from(const Surface& surface, const Eigen::Vector3f& place) {
  return !surface.one_sided || surface.normal.dot(place) > surface.offset_m;
}

/// The static geometry that the robot knows, in W, metres, z up. Plain arrays: made once by the loader, never changed after. The world model of section 4.2.
struct Map {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Triangle> triangles;  ///< those of a surface lie together.
  std::vector<Surface> surfaces;
  std::vector<Edge> edges;
  std::vector<Material> materials;
};

/// \return whether an edge may be seen from a place in W: one of its surfaces is, or it has none.
inline bool is_seen_from(const Map& map, const Edge& edge, const Eigen::Vector3f& place) {
  bool has_surface = false;
  for (const std::uint32_t surface : edge.surfaces) {
    if (surface == kNone) continue;
    if (is_seen_from(map.surfaces[surface], place)) return true;
    has_surface = true;
  }
  return !has_surface;
}

/// \return the luma of a colour as it is encoded (BT.601), 0..1.
inline float luma_of(const Eigen::Vector3f& color) {
  return 0.299F * color.x() + 0.587F * color.y() + 0.114F * color.z();
}

/// \return the luma that the map expects beside an edge (side 0: left, 1: right, as Edge::sides); nothing where it does not know. Light is
///         not part of it: only between sides of one plane is the darker one sure to look darker.
inline std::optional<float> side_luma(const Map& map, const Edge& edge, int side) {
  const std::uint32_t surface = edge.sides[static_cast<std::size_t>(side)];
  if (surface == kNone) return std::nullopt;
  const Material& material = map.materials[map.surfaces[surface].material];
  if (!material.known_color) return std::nullopt;
  return luma_of(material.color);
}

}  // namespace cgsr::world
