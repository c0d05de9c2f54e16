#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipeline/world/clean.h"
#include "pipeline/world/map.h"
#include "pipeline/world/soup.h"

namespace cgsr::world {

/// Meshes by hand. Corners are never shared here: to find them is the clean-up's work.
class Maker {
 public:
  using Point = Eigen::Vector3f;

  std::uint32_t material(const std::string& name, float grey) {
    soup_.materials.push_back({name, Eigen::Vector3f::Constant(grey), true});
    return static_cast<std::uint32_t>(soup_.materials.size() - 1);
  }

  void face(std::span<const Point> outline, std::uint32_t material = 0) {
    soup_.faces.push_back(
        {static_cast<std::uint32_t>(soup_.corners.size()), static_cast<std::uint32_t>(outline.size()), material});
    for (const Point& p : outline) {
      soup_.corners.push_back(static_cast<std::uint32_t>(soup_.points.size()));
      soup_.points.push_back(p);
    }
  }
  void face(std::initializer_list<Point> outline, std::uint32_t material = 0) {
    face(std::span<const Point>(outline.begin(), outline.size()), material);
  }

  /// Level, from one corner to the other; its front is up.
  void level(float x0, float y0, float x1, float y1, float z, std::uint32_t material = 0) {
    face({{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}, material);
  }

  /// Six sides, fronts outwards.
  void box(const Point& low, const Point& high, std::uint32_t material = 0) {
    const auto at = [&](int x, int y, int z) {
      return Point(x != 0 ? high.x() : low.x(), y != 0 ? high.y() : low.y(), z != 0 ? high.z() : low.z());
    };
    face({at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)}, material);
    face({at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)}, material);
    face({at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)}, material);
    face({at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)}, material);
    face({at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)}, material);
    face({at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)}, material);
  }

  void line(const Point& a, const Point& b) {
    const auto first = static_cast<std::uint32_t>(soup_.points.size());
    soup_.points.push_back(a);
    soup_.points.push_back(b);
    soup_.lines.push_back({first, first + 1});
  }

  [[nodiscard]] const Soup& soup() const { return soup_; }

  [[nodiscard]] Map map() {
    if (soup_.materials.empty()) material("plain", 0.5F);
    auto map = clean(soup_, 1e-4, 0.02);
    EXPECT_TRUE(map) << map.error().message;
    return map ? *map : Map{};
  }

 private:
  Soup soup_;
};

inline int count(const Map& map, EdgeKind kind) {
  int found = 0;
  for (const Edge& edge : map.edges) found += edge.kind == kind ? 1 : 0;
  return found;
}

/// The edge between two points, whichever way it runs; a default one (no surface, no contrast) when there is none.
inline Edge edge_between(const Map& map, const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  for (const Edge& edge : map.edges) {
    const Eigen::Vector3f& p = map.vertices[edge.vertices[0]];
    const Eigen::Vector3f& q = map.vertices[edge.vertices[1]];
    if (((p - a).norm() < 1e-3F && (q - b).norm() < 1e-3F) || ((p - b).norm() < 1e-3F && (q - a).norm() < 1e-3F))
      return edge;
  }
  ADD_FAILURE() << "no edge between (" << a.transpose() << ") and (" << b.transpose() << ")";
  return {};
}

inline std::string material_of(const Map& map, std::uint32_t surface) {
  return surface == kNone ? "" : map.materials[map.surfaces[surface].material].name;
}

inline double area_of(const Map& map) {
  double area = 0.0;
  for (const Triangle& t : map.triangles) {
    const Eigen::Vector3d a = map.vertices[t[0]].cast<double>();
    area += 0.5 * (map.vertices[t[1]].cast<double>() - a).cross(map.vertices[t[2]].cast<double>() - a).norm();
  }
  return area;
}

}  // namespace cgsr::world
