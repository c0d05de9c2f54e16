#include "pipeline/world/clean.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "pipeline/world/beside.h"
#include "pipeline/world/index.h"
#include "pipeline/world/join.h"
#include "pipeline/world/outlines.h"
#include "pipeline/world/tree.h"
#include "pipeline/world/triangulate.h"
#include "pipeline/world/weld.h"

namespace cgsr::world {
namespace {

Result<void> check(const Soup& soup) {
  if (soup.faces.empty() && soup.lines.empty()) return fail("there is no surface in it");
  if (soup.faces.size() > kLargestFaces)
    return fail(fmt::format("{} faces are more than {}", soup.faces.size(), kLargestFaces));
  if (soup.corners.size() > kLargestCorners || soup.points.size() > kLargestCorners)
    return fail(
        fmt::format("{} corners are more than {}", std::max(soup.corners.size(), soup.points.size()), kLargestCorners));
  Bounds box;
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    const Eigen::Vector3f& p = soup.points[i];
    if (!p.allFinite()) return fail(fmt::format("corner {} is not finite: ({}, {}, {})", i, p.x(), p.y(), p.z()));
    box.add(p);
  }
  if (soup.points.empty()) return fail("there is no corner in it");
  const float extent = (box.high - box.low).maxCoeff();
  const float away = std::max(box.high.abs().maxCoeff(), box.low.abs().maxCoeff());
  if (!(extent <= kLargestExtent_m) || !(away <= kLargestExtent_m))
    return fail(fmt::format(
        "it reaches {:.6g} m from the origin and is {:.6g} m across: expected at most {:.0f} km (another unit?)", away,
        extent, kLargestExtent_m / 1000.0F));
  for (const Soup::Face& face : soup.faces) {
    if (face.count > kLargestOutline)
      return fail(fmt::format("a face of {} corners: expected at most {}", face.count, kLargestOutline));
  }
  return {};
}

// Without area: lower than corners may be apart.
bool is_thin(const Triangle& t, std::span<const Eigen::Vector3f> points, double weld_m) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
  const Eigen::Vector3d a = points[t[0]].cast<double>();
  const Eigen::Vector3d ab = points[t[1]].cast<double>() - a;
  const Eigen::Vector3d ac = points[t[2]].cast<double>() - a;
  const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
  return !(ab.cross(ac).norm() > weld_m * longest);
}

Eigen::Vector3d area_of(const Triangle& t, std::span<const Eigen::Vector3f> points) {
  const Eigen::Vector3d a = points[t[0]].cast<double>();
  return (points[t[1]].cast<double>() - a).cross(points[t[2]].cast<double>() - a);
}

// One face of a file whose corners were measured by hand lies in no plane. A ruled surface bent by more is another thing: what its diagonal
// looks like is not known, and it stays a crease.
bool is_warped(std::span<const Triangle> cut, std::span<const Eigen::Vector3f> points) {
  const double least_cos = std::cos(10.0 * std::numbers::pi / 180.0);
  if (cut.size() < 2) return false;
  Eigen::Vector3d whole = Eigen::Vector3d::Zero();
  for (const Triangle& triangle : cut) whole += area_of(triangle, points);
  const Eigen::Vector3d n = whole.normalized();
  return std::ranges::all_of(cut, [&](const Triangle& triangle) {
    const Eigen::Vector3d area = area_of(triangle, points);
    return area.dot(n) >= least_cos * area.norm();
  });
}

// The sides of its triangles that are none of the face's own.
void add_diagonals(std::span<const std::uint32_t> outline, std::span<const Triangle> cut,
                   std::vector<std::array<std::uint32_t, 2>>& diagonals) {
  const auto side = [](std::uint32_t a, std::uint32_t b) { return std::array{std::min(a, b), std::max(a, b)}; };
  std::vector<std::array<std::uint32_t, 2>> own;
  for (std::size_t i = 0; i < outline.size(); ++i) own.push_back(side(outline[i], outline[(i + 1) % outline.size()]));
  std::ranges::sort(own);
  for (const Triangle& triangle : cut) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto inner = side(triangle[i], triangle[(i + 1) % 3]);
      if (!std::ranges::binary_search(own, inner)) diagonals.push_back(inner);
    }
  }
}

// The same triangles, surfaces and edges, each in the order in which the index's trees have them; vertices as they are first used.
class Orderer {
 public:
  explicit Orderer(Map& map) : map_(map) {}

  void run() {
    order_surfaces();
    order_edges();
    order_vertices();
  }

 private:
  void order_surfaces() {
    const Tree tree = tree_of_triangles(map_);
    std::vector<std::uint32_t> rank(map_.triangles.size());
    for (std::uint32_t i = 0; i < rank.size(); ++i) rank[tree.order()[i]] = i;
    // A surface stands where the first of its triangles does; its triangles stay together.
    std::vector<std::uint32_t> first(map_.surfaces.size(), kNone);
    for (std::size_t s = 0; s < first.size(); ++s) {
      const Surface& surface = map_.surfaces[s];
      for (std::uint32_t t = 0; t < surface.triangle_count; ++t)
        first[s] = std::min(first[s], rank[surface.first_triangle + t]);
    }
    std::vector<std::uint32_t> order(first.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return first[a] < first[b]; });
    std::vector<std::uint32_t> became(order.size());
    std::vector<Surface> surfaces;
    std::vector<Triangle> triangles;
    surfaces.reserve(map_.surfaces.size());
    triangles.reserve(map_.triangles.size());
    std::vector<std::uint32_t> own;
    for (const std::uint32_t s : order) {
      became[s] = static_cast<std::uint32_t>(surfaces.size());
      Surface surface = map_.surfaces[s];
      own.resize(surface.triangle_count);
      std::iota(own.begin(), own.end(), surface.first_triangle);
      std::sort(own.begin(), own.end(), [&](std::uint32_t a, std::uint32_t b) { return rank[a] < rank[b]; });
      surface.first_triangle = static_cast<std::uint32_t>(triangles.size());
      for (const std::uint32_t t : own) triangles.push_back(map_.triangles[t]);
      surfaces.push_back(surface);
    }
    map_.surfaces.swap(surfaces);
    map_.triangles.swap(triangles);
    for (Edge& edge : map_.edges) {
      for (std::uint32_t& s : edge.surfaces) s = s == kNone ? kNone : became[s];
      for (std::uint32_t& s : edge.sides) s = s == kNone ? kNone : became[s];
    }
  }

  void order_edges() {
    const Tree tree = tree_of_edges(map_);
    std::vector<Edge> edges;
    edges.reserve(map_.edges.size());
    for (const std::uint32_t e : tree.order()) edges.push_back(map_.edges[e]);
    map_.edges.swap(edges);
  }

  void order_vertices() {
    std::vector<std::uint32_t> became(map_.vertices.size(), kNone);
    std::vector<Eigen::Vector3f> vertices;
    vertices.reserve(map_.vertices.size());
    const auto take = [&](std::uint32_t& v) {
      if (became[v] == kNone) {
        became[v] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(map_.vertices[v]);
      }
      v = became[v];
    };
    for (Edge& edge : map_.edges) {
      for (std::uint32_t& v : edge.vertices) take(v);
    }
    for (Triangle& triangle : map_.triangles) {
      for (std::uint32_t& v : triangle) take(v);
    }
    vertices.shrink_to_fit();
    map_.vertices.swap(vertices);
  }

  Map& map_;
};

}  // namespace

Result<Map> clean(const Soup& soup, double weld_m, double lies_on_m) {
  if (auto good = check(soup); !good) return tl::unexpected(good.error());
  Map map;
  map.materials = soup.materials;
  const std::vector<std::uint32_t> became = weld(soup.points, weld_m, map.vertices);

  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> materials;
  triangles.reserve(soup.corners.size());
  materials.reserve(soup.corners.size());
  std::vector<std::array<std::uint32_t, 2>> diagonals;
  std::vector<std::uint32_t> outline;
  std::vector<Triangle> cut;
  for (const Soup::Face& face : soup.faces) {
    outline.clear();
    for (std::uint32_t i = 0; i < face.count; ++i) {
      const std::uint32_t v = became[soup.corners[face.first + i]];
      if (outline.empty() || outline.back() != v) outline.push_back(v);
    }
    while (outline.size() > 1 && outline.front() == outline.back()) outline.pop_back();
    cut.clear();
    triangulate(outline, map.vertices, cut);
    if (is_warped(cut, map.vertices)) add_diagonals(outline, cut, diagonals);
    for (const Triangle& triangle : cut) {
      if (is_thin(triangle, map.vertices, weld_m)) continue;
      triangles.push_back(triangle);
      materials.push_back(face.material);
    }
  }
  if (triangles.empty()) return fail("there is no surface with an area in it");
  if (auto joined = join(triangles, materials, weld_m, soup.one_sided, map); !joined)
    return tl::unexpected(joined.error());
  std::vector<std::array<std::uint32_t, 2>> lines;
  lines.reserve(soup.lines.size());
  for (const auto& line : soup.lines) lines.push_back({became[line[0]], became[line[1]]});
  std::sort(diagonals.begin(), diagonals.end());
  if (!trace_outlines(lines, diagonals, weld_m, map))
    return fail("its faces lie through each other nearly everywhere: this is no map of a place");
  look_beside(lies_on_m, map);
  Orderer(map).run();
  return map;
}

}  // namespace cgsr::world
