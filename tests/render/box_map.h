#pragma once

#include <array>

#include "pipeline/geometry/pose.h"
#include "pipeline/world/map.h"

namespace cgsr::render {

/// Adds a rectangle with its four borders; e1 x e2 is its front.
inline void add_rectangle(world::Map& map, const Eigen::Vector3f& corner, const Eigen::Vector3f& e1,
                          const Eigen::Vector3f& e2) {
  const auto v = static_cast<std::uint32_t>(map.vertices.size());
  const auto s = static_cast<std::uint32_t>(map.surfaces.size());
  for (const Eigen::Vector3f& p :
       {corner, Eigen::Vector3f(corner + e1), Eigen::Vector3f(corner + e1 + e2), Eigen::Vector3f(corner + e2)}) {
    map.vertices.push_back(p);
  }
  world::Surface surface;
  surface.first_triangle = static_cast<std::uint32_t>(map.triangles.size());
  surface.triangle_count = 2;
  surface.normal = e1.cross(e2).normalized();
  surface.offset_m = surface.normal.dot(corner);
  map.surfaces.push_back(surface);
  map.triangles.push_back({v, v + 1, v + 2});
  map.triangles.push_back({v, v + 2, v + 3});
  for (std::uint32_t i = 0; i < 4; ++i) {
    world::Edge edge;
    edge.vertices = {v + i, v + (i + 1) % 4};
    edge.surfaces = {s, world::kNone};
    edge.kind = world::EdgeKind::kBorder;
    edge.contrast = 0.25F;
    map.edges.push_back(edge);
  }
}

/// Adds a box: 8 vertices, 6 surfaces, 12 creases. Axes of W.
inline void add_box(world::Map& map, const Eigen::Vector3f& least, const Eigen::Vector3f& most) {
  const auto v = static_cast<std::uint32_t>(map.vertices.size());
  const auto s = static_cast<std::uint32_t>(map.surfaces.size());
  for (std::uint32_t i = 0; i < 8; ++i) {
    map.vertices.emplace_back((i & 1U) != 0U ? most.x() : least.x(), (i & 2U) != 0U ? most.y() : least.y(),
                              (i & 4U) != 0U ? most.z() : least.z());
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{{{0, 4, 6, 2},  // -x
                                                                {1, 3, 7, 5},  // +x
                                                                {0, 1, 5, 4},  // -y
                                                                {2, 6, 7, 3},  // +y
                                                                {0, 2, 3, 1},  // -z
                                                                {4, 5, 7, 6}}};
  for (const auto& face : kFaces) {
    world::Surface surface;
    surface.first_triangle = static_cast<std::uint32_t>(map.triangles.size());
    surface.triangle_count = 2;
    const Eigen::Vector3f& a = map.vertices[v + face[0]];
    surface.normal = (map.vertices[v + face[1]] - a).cross(map.vertices[v + face[2]] - a).normalized();
    surface.offset_m = surface.normal.dot(a);
    map.surfaces.push_back(surface);
    map.triangles.push_back({v + face[0], v + face[1], v + face[2]});
    map.triangles.push_back({v + face[0], v + face[2], v + face[3]});
  }
  const auto faces_with = [&](std::uint32_t a, std::uint32_t b) {
    std::array<std::uint32_t, 2> sides{world::kNone, world::kNone};
    for (std::uint32_t f = 0; f < 6; ++f) {
      for (std::uint32_t i = 0; i < 4; ++i) {
        if (kFaces[f][i] == a && kFaces[f][(i + 1) % 4] == b) sides[0] = s + f;
        if (kFaces[f][i] == b && kFaces[f][(i + 1) % 4] == a) sides[1] = s + f;
      }
    }
    return sides;
  };
  for (std::uint32_t a = 0; a < 8; ++a) {
    for (const std::uint32_t bit : {1U, 2U, 4U}) {
      if ((a & bit) != 0U) continue;
      world::Edge edge;
      edge.vertices = {v + a, v + (a | bit)};
      edge.surfaces = faces_with(a, a | bit);
      edge.contrast = 0.2F;
      map.edges.push_back(edge);
    }
  }
}

/// Faces that are seen from the front alone, as a .cao has them: a box whose fronts are inside shows the other corner, through what is before it.
inline void turn_inside_out(world::Map& map) {
  for (world::Surface& surface : map.surfaces) {
    surface.normal = -surface.normal;
    surface.offset_m = -surface.offset_m;
    surface.one_sided = true;
  }
}

/// A camera at p_WC whose axis points at p_WT, level.
inline geometry::Pose looking_from(const Eigen::Vector3d& p_WC, const Eigen::Vector3d& p_WT) {
  const Eigen::Vector3d z = (p_WT - p_WC).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  geometry::Pose X_WC = geometry::Pose::Identity();
  X_WC.linear().col(0) = x;
  X_WC.linear().col(1) = z.cross(x);
  X_WC.linear().col(2) = z;
  X_WC.translation() = p_WC;
  return X_WC;
}

}  // namespace cgsr::render
