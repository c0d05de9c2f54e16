#include "hal/sim/scene/mesh.h"

#include <cstddef>

namespace cgsr::sim {

void Mesh::append(const Mesh& other) {
  const auto first_corner = static_cast<std::uint32_t>(position_m.size());
  const auto first_polygon = static_cast<std::uint32_t>(polygons.size());
  position_m.insert(position_m.end(), other.position_m.begin(), other.position_m.end());
  normal.insert(normal.end(), other.normal.begin(), other.normal.end());
  uv.insert(uv.end(), other.uv.begin(), other.uv.end());
  for (Triangle triangle : other.triangles) {
    for (std::uint32_t& corner : triangle.corner) corner += first_corner;
    triangle.polygon += first_polygon;
    triangles.push_back(triangle);
  }
  for (std::vector<std::uint32_t> outline : other.polygons) {
    for (std::uint32_t& corner : outline) corner += first_corner;
    polygons.push_back(std::move(outline));
  }
  smooth = smooth || other.smooth;
}

void Mesh::transform(const Pose& X_AB) {
  const Eigen::Isometry3f X = X_AB.cast<float>();
  for (Eigen::Vector3f& p : position_m) p = X * p;
  for (Eigen::Vector3f& n : normal) n = X.linear() * n;
}

void Mesh::add_polygon(const std::vector<Eigen::Vector3f>& corners_m,
                       const std::vector<Eigen::Vector2f>& uv_of_corners) {
  const auto first = static_cast<std::uint32_t>(position_m.size());
  const auto polygon = static_cast<std::uint32_t>(polygons.size());
  const Eigen::Vector3f n = (corners_m[1] - corners_m[0]).cross(corners_m[2] - corners_m[0]).normalized();
  std::vector<std::uint32_t> outline;
  for (std::size_t i = 0; i < corners_m.size(); ++i) {
    position_m.push_back(corners_m[i]);
    normal.push_back(n);
    uv.push_back(uv_of_corners[i]);
    outline.push_back(first + static_cast<std::uint32_t>(i));
  }
  for (std::size_t i = 2; i < corners_m.size(); ++i) {
    triangles.push_back({{outline[0], outline[i - 1], outline[i]}, polygon});
  }
  polygons.push_back(std::move(outline));
}

void Mesh::smooth_normals() {
  for (Eigen::Vector3f& n : normal) n.setZero();
  for (const Triangle& t : triangles) {
    const Eigen::Vector3f& a = position_m[t.corner[0]];
    const Eigen::Vector3f area = (position_m[t.corner[1]] - a).cross(position_m[t.corner[2]] - a);
    for (const std::uint32_t corner : t.corner) normal[corner] += area;
  }
  for (Eigen::Vector3f& n : normal) {
    const float length = n.norm();
    n = length > 0.0F ? Eigen::Vector3f(n / length) : Eigen::Vector3f::UnitZ();
  }
  smooth = true;
}

Eigen::AlignedBox3f bounds(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : mesh.position_m) box.extend(p);
  return box;
}

}  // namespace cgsr::sim
