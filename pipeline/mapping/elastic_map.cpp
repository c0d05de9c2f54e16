#include "pipeline/mapping/elastic_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>

namespace cgsr::mapping {
namespace {

constexpr double kOnFloor_m = 0.02;
constexpr double kSame_m = 2e-4;             // what the loader makes one corner
constexpr std::size_t kLargestOutline = 64;  // of a face whose corners are all tied to each other

/// Finds the corner at a place.
class CornersByPlace {
 public:
  explicit CornersByPlace(std::vector<Eigen::Vector3d>& corners) : corners_(&corners) {}

  [[nodiscard]] std::optional<std::uint32_t> at(const Eigen::Vector3d& p) const {
    const Key middle = key_of(p);
    for (int i = 0; i < 27; ++i) {
      const Key key{middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1};
      const auto found = cells_.find(key);
      if (found == cells_.end()) continue;
      for (const std::uint32_t corner : found->second) {
        if (((*corners_)[corner] - p).norm() <= kSame_m) return corner;
      }
    }
    return std::nullopt;
  }

  std::uint32_t add(const Eigen::Vector3d& p) {
    if (const auto found = at(p)) return *found;
    corners_->push_back(p);
    const auto corner = static_cast<std::uint32_t>(corners_->size() - 1);
    cells_[key_of(p)].push_back(corner);
    return corner;
  }

 private:
  using Key = std::array<std::int64_t, 3>;
  static Key key_of(const Eigen::Vector3d& p) {
    return {std::llround(p.x() / kSame_m), std::llround(p.y() / kSame_m), std::llround(p.z() / kSame_m)};
  }
  std::vector<Eigen::Vector3d>* corners_;
  std::map<Key, std::vector<std::uint32_t>> cells_;
};

std::string thing_of(const std::string& name) {
  return name.substr(0, name.find('/'));
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

Result<ElasticMap> ElasticMap::make(const ObjMap& file, world::Map map, const RefineParameters& parameters) {
  ElasticMap made;
  made.map_ = std::move(map);
  if (auto found = made.find_corners(file); !found) return tl::unexpected(found.error());
  made.corners_ = made.measured_;
  made.find_parts(file);
  made.tie(file, parameters);
  made.find_contacts(parameters);
  made.sigmas_.resize(made.measured_.size(), parameters.map_sigma_m);
  for (const Part& part : made.parts_) {
    const double ratio = std::min(1.0, parameters.shape_sigma_m / parameters.map_sigma_m);
    const double together = 1.0 + (1.0 - ratio * ratio) * static_cast<double>(part.corners.size() - 1);
    for (const std::uint32_t corner : part.corners) made.sigmas_[corner] *= std::sqrt(together);
  }
  return made;
}

Result<void> ElasticMap::find_corners(const ObjMap& file) {
  CornersByPlace places(measured_);
  for (const Eigen::Vector3d& p : file.points) corner_of_point_.push_back(places.add(p));
  for (const Eigen::Vector3f& p : map_.vertices) {
    const auto corner = places.at(p.cast<double>());
    if (!corner) {
      return fail(fmt::format("the corner ({}, {}, {}) of the map is none of its file's: expected metres and z up",
                              p.x(), p.y(), p.z()));
    }
    corner_of_vertex_.push_back(*corner);
  }
  return {};
}

void ElasticMap::find_parts(const ObjMap& file) {
  const auto corners = static_cast<std::uint32_t>(measured_.size());
  std::vector<std::uint32_t> parent(corners);
  std::iota(parent.begin(), parent.end(), 0U);
  std::map<std::string, std::uint32_t> first_of;
  const bool named = file.parts.size() > 1;
  for (const ObjMap::Face& face : file.faces) {
    const std::uint32_t first = corner_of_point_[face.corners[0]];
    for (const std::uint32_t point : face.corners) {
      parent[root_of(parent, corner_of_point_[point])] = root_of(parent, first);
    }
    if (!named) continue;
    const auto [known, is_new] = first_of.try_emplace(thing_of(file.parts[face.part]), first);
    if (!is_new) parent[root_of(parent, first)] = root_of(parent, known->second);
  }
  std::vector<std::string> part_name(corners);
  for (const ObjMap::Face& face : file.faces) {
    for (const std::uint32_t point : face.corners) {
      std::string& name = part_name[corner_of_point_[point]];
      if (name.empty()) name = thing_of(file.parts[face.part]);
    }
  }
  part_of_.resize(corners);
  std::map<std::uint32_t, std::uint32_t> part_of_root;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const auto [known, is_new] =
        part_of_root.try_emplace(root_of(parent, i), static_cast<std::uint32_t>(parts_.size()));
    if (is_new) parts_.push_back({part_name[i], {}});
    part_of_[i] = known->second;
    parts_[known->second].corners.push_back(i);
  }
}

Tie ElasticMap::tie_between(std::uint32_t a, std::uint32_t b, const RefineParameters& parameters) const {
  const double length = (measured_[a] - measured_[b]).norm();
  return {a, b, std::hypot(parameters.shape_sigma_m, parameters.size_share * length),
          std::hypot(parameters.shape_sigma_m, parameters.turn_sigma_rad * length)};
}

void ElasticMap::tie(const ObjMap& file, const RefineParameters& parameters) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> tied;
  std::vector<std::uint32_t> object_of(measured_.size(), 0);
  for (const ObjMap::Face& face : file.faces) {
    const std::size_t count = face.corners.size();
    for (std::size_t i = 0; i < count; ++i) {
      object_of[corner_of_point_[face.corners[i]]] = face.part;
      const std::size_t most = count <= kLargestOutline ? count : std::min(count, i + 3);
      for (std::size_t k = i + 1; k < most; ++k) {
        const auto [a, b] = std::minmax(corner_of_point_[face.corners[i]], corner_of_point_[face.corners[k]]);
        if (a != b) tied.emplace(a, b);
      }
    }
  }
  for (const auto& [a, b] : tied) {
    ties_.push_back(tie_between(a, b, parameters));
  }
  for (const Part& part : parts_) tie_nearest(object_of, part, parameters);
}

// The pieces of a thing hold together: each corner with the nearest one of another piece.
void ElasticMap::tie_nearest(const std::vector<std::uint32_t>& object_of, const Part& part,
                             const RefineParameters& parameters) {
  for (const std::uint32_t a : part.corners) {
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t with = a;
    for (const std::uint32_t b : part.corners) {
      if (object_of[a] == object_of[b]) continue;
      const double distance = (measured_[a] - measured_[b]).norm();
      if (distance < nearest) {
        nearest = distance;
        with = b;
      }
    }
    if (with == a) continue;
    ties_.push_back(tie_between(a, with, parameters));
  }
}

void ElasticMap::find_contacts(const RefineParameters& parameters) {
  // Where corners are off by themselves, what seems to lie on something says nothing.
  if (parameters.shape_sigma_m >= parameters.map_sigma_m) return;
  for (const world::Triangle& triangle : map_.triangles) {
    std::array<std::uint32_t, 3> on{};
    for (std::size_t k = 0; k < 3; ++k) on.at(k) = corner_of_vertex_[triangle.at(k)];
    const Eigen::Vector3d& a = measured_[on[0]];
    const Eigen::Vector3d u = measured_[on[1]] - a;
    const Eigen::Vector3d v = measured_[on[2]] - a;
    const Eigen::Vector3d across = u.cross(v);
    const double area = across.norm();
    if (!(area > 1e-4)) continue;
    const Eigen::Vector3d normal = across / area;
    for (std::uint32_t i = 0; i < measured_.size(); ++i) {
      const Eigen::Vector3d d = measured_[i] - a;
      if (std::abs(normal.dot(d)) > parameters.lies_on_m || part_of_[i] == part_of_[on[0]]) continue;
      const double by_v = normal.dot(u.cross(d)) / area;
      const double by_u = normal.dot(d.cross(v)) / area;
      const Eigen::Vector3d weights(1.0 - by_u - by_v, by_u, by_v);
      if (weights.minCoeff() < -0.01) continue;
      contacts_.push_back({i, on, weights, normal});
    }
  }
}

bool ElasticMap::stands_on_floor(std::uint32_t part) const {
  return std::ranges::any_of(parts_[part].corners,
                             [this](std::uint32_t corner) { return measured_[corner].z() < kOnFloor_m; });
}

std::array<std::uint32_t, 2> ElasticMap::ends_of(std::uint32_t edge) const {
  const auto& vertices = map_.edges[edge].vertices;
  return {corner_of_vertex_[vertices[0]], corner_of_vertex_[vertices[1]]};
}

void ElasticMap::move(const std::vector<Eigen::Vector3d>& corners) {
  corners_ = corners;
  for (std::size_t i = 0; i < map_.vertices.size(); ++i) {
    map_.vertices[i] = corners[corner_of_vertex_[i]].cast<float>();
  }
  for (world::Surface& surface : map_.surfaces) {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    float area = 0.0F;
    float offset = 0.0F;
    for (std::uint32_t i = 0; i < surface.triangle_count; ++i) {
      const world::Triangle& t = map_.triangles[surface.first_triangle + i];
      const Eigen::Vector3f& a = map_.vertices[t[0]];
      normal += (map_.vertices[t[1]] - a).cross(map_.vertices[t[2]] - a);
    }
    if (!(normal.norm() > 0.0F)) continue;
    surface.normal = normal.normalized();
    for (std::uint32_t i = 0; i < surface.triangle_count; ++i) {
      const world::Triangle& t = map_.triangles[surface.first_triangle + i];
      const Eigen::Vector3f& a = map_.vertices[t[0]];
      const float twice = (map_.vertices[t[1]] - a).cross(map_.vertices[t[2]] - a).norm();
      area += twice;
      offset += twice * surface.normal.dot(a + map_.vertices[t[1]] + map_.vertices[t[2]]) / 3.0F;
    }
    surface.offset_m = offset / area;
  }
}

std::vector<Eigen::Vector3d> ElasticMap::points(const ObjMap& file, const std::vector<Eigen::Vector3d>& corners) const {
  std::vector<Eigen::Vector3d> moved = file.points;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const std::uint32_t corner = corner_of_point_[i];
    moved[i] += corners[corner] - measured_[corner];
  }
  return moved;
}

}  // namespace cgsr::mapping
