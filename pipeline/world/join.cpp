#include "pipeline/world/join.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "pipeline/world/soup.h"

namespace cgsr::world {
namespace {

// Two planes that differ by less are one; a curve's facets differ by more (360 of them to a turn would not).
const double kCosFlat = std::cos(0.6 * 3.14159265358979 / 180.0);
constexpr double kFlat_m = 5e-4;
// Where more triangles than this share an edge nothing is joined: such a mesh is not of this world, and must not cost an age.
constexpr std::uint32_t kMostAtEdge = 32;

struct Side {
  std::uint64_t edge = 0;  ///< smaller corner in the high half, larger one in the low.
  std::uint32_t triangle = 0;
  bool operator<(const Side& other) const { return edge != other.edge ? edge < other.edge : triangle < other.triangle; }
};

class Joiner {
 public:
  Joiner(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& materials, double weld_m,
         bool one_sided, Map& map)
      : triangles_(triangles), materials_(materials), weld_m_(weld_m), one_sided_(one_sided), map_(map) {}

  Result<void> run() {
    measure();
    list_sides();
    if (auto good = check_fans(); !good) return good;
    grow();
    drop_doubles();
    deliver();
    return {};
  }

 private:
  static constexpr std::uint32_t kFree = kNone;

  [[nodiscard]] Eigen::Vector3d point(std::uint32_t v) const { return map_.vertices[v].cast<double>(); }

  void measure() {
    normals_.reserve(triangles_.size());
    areas_.reserve(triangles_.size());
    heights_.reserve(triangles_.size());
    for (const Triangle& t : triangles_) {
      const Eigen::Vector3d ab = point(t[1]) - point(t[0]);
      const Eigen::Vector3d ac = point(t[2]) - point(t[0]);
      const Eigen::Vector3d area = ab.cross(ac);
      const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
      normals_.push_back(area.normalized());
      areas_.push_back(area.norm());
      heights_.push_back(area.norm() / longest);
    }
  }

  // Every triangle's three sides, sorted by edge; of triangles with the same corners only the first.
  void list_sides() {
    std::vector<std::uint32_t> by_corners(triangles_.size());
    std::iota(by_corners.begin(), by_corners.end(), 0U);
    std::vector<Triangle> sorted = triangles_;
    for (Triangle& t : sorted) std::sort(t.begin(), t.end());
    std::sort(by_corners.begin(), by_corners.end(),
              [&](std::uint32_t a, std::uint32_t b) { return sorted[a] != sorted[b] ? sorted[a] < sorted[b] : a < b; });
    group_.assign(triangles_.size(), kFree);
    gone_.assign(triangles_.size(), false);
    given_both_ways_.assign(triangles_.size(), false);
    std::size_t kept = 0;
    for (std::size_t i = 1; i < by_corners.size(); ++i) {
      if (sorted[by_corners[i]] != sorted[by_corners[kept]]) {
        kept = i;
        continue;
      }
      gone_[by_corners[i]] = true;
      if (normals_[by_corners[i]].dot(normals_[by_corners[kept]]) < 0.0) given_both_ways_[by_corners[kept]] = true;
    }
    sides_.reserve(3 * triangles_.size());
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (gone_[i]) continue;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t a = triangles_[i][corner];
        const std::uint32_t b = triangles_[i][(corner + 1) % 3];
        sides_.push_back({(static_cast<std::uint64_t>(std::min(a, b)) << 32U) | std::max(a, b), i});
      }
    }
    std::sort(sides_.begin(), sides_.end());
    where_.assign(triangles_.size(), {});
    std::vector<std::uint8_t> seen(triangles_.size(), 0);
    for (std::uint32_t i = 0; i < sides_.size(); ++i) {
      const std::uint32_t t = sides_[i].triangle;
      where_[t][seen[t]++] = i;
    }
  }

  // Everything looks at all of an edge's neighbours, and no box in a tree keeps them apart: a fan of very many would cost an age.
  [[nodiscard]] Result<void> check_fans() const {
    for (std::size_t i = 0; i < sides_.size();) {
      const std::size_t first = i;
      for (; i < sides_.size() && sides_[i].edge == sides_[first].edge; ++i) continue;
      if (i - first <= kLargestFan) continue;
      const Eigen::Vector3d a = point(static_cast<std::uint32_t>(sides_[first].edge >> 32U));
      const Eigen::Vector3d b = point(static_cast<std::uint32_t>(sides_[first].edge & 0xFFFFFFFFU));
      return fail(
          fmt::format("{} triangles share the edge from ({:.3f}, {:.3f}, {:.3f}) to ({:.3f}, {:.3f}, {:.3f}): expected "
                      "at most {}; this is no map of a place",
                      i - first, a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), kLargestFan));
    }
    return {};
  }

  // From the largest triangle that is left, over edges, as far as the plane goes.
  void grow() {
    std::vector<std::uint32_t> by_area(triangles_.size());
    std::iota(by_area.begin(), by_area.end(), 0U);
    std::sort(by_area.begin(), by_area.end(),
              [&](std::uint32_t a, std::uint32_t b) { return areas_[a] != areas_[b] ? areas_[a] > areas_[b] : a < b; });
    std::vector<std::uint32_t> front;
    for (const std::uint32_t seed : by_area) {
      if (gone_[seed] || group_[seed] != kFree) continue;
      const auto group = static_cast<std::uint32_t>(seeds_.size());
      seeds_.push_back(seed);
      members_.emplace_back();
      group_[seed] = group;
      front.assign(1, seed);
      while (!front.empty()) {
        const std::uint32_t at = front.back();
        front.pop_back();
        members_[group].push_back(at);
        for (const std::uint32_t side : where_[at]) {
          const std::uint32_t next = beyond(side, seed);
          if (next == kNone || group_[next] != kFree) continue;
          group_[next] = group;
          front.push_back(next);
        }
      }
    }
  }

  // The triangle that carries on the seed's plane across an edge. Where a sheet was given twice there are two of them: the one wound the same
  // way then.
  [[nodiscard]] std::uint32_t beyond(std::uint32_t side, std::uint32_t seed) const {
    const Side& own = sides_[side];
    std::uint32_t begin = side;
    while (begin > 0 && sides_[begin - 1].edge == own.edge && side - begin <= kMostAtEdge) --begin;
    std::uint32_t found = kNone;
    int count = 0;
    bool found_turned = true;
    for (std::uint32_t i = begin; i < sides_.size() && sides_[i].edge == own.edge; ++i) {
      if (i - begin > kMostAtEdge) return kNone;
      const std::uint32_t other = sides_[i].triangle;
      if (other == own.triangle || materials_[other] != materials_[seed]) continue;
      if (!in_plane(other, seed) || !across(own, sides_[i])) continue;
      ++count;
      const bool turned = normals_[own.triangle].dot(normals_[other]) < 0.0;
      if (found == kNone || (found_turned && !turned)) {
        found = other;
        found_turned = turned;
      }
    }
    return count <= 1 || !found_turned ? found : kNone;
  }

  [[nodiscard]] bool in_plane(std::uint32_t other, std::uint32_t seed) const {
    const Eigen::Vector3d& n = normals_[seed];
    // A splinter's own normal means little.
    if (heights_[other] > 10.0 * weld_m_ && std::abs(normals_[other].dot(n)) < kCosFlat) return false;
    const double offset = n.dot(point(triangles_[seed][0]));
    for (const std::uint32_t v : triangles_[other]) {
      if (std::abs(n.dot(point(v)) - offset) > kFlat_m) return false;
    }
    return true;
  }

  // They lie on opposite sides of their edge, not folded onto each other.
  [[nodiscard]] bool across(const Side& a, const Side& b) const {
    const auto v0 = static_cast<std::uint32_t>(a.edge >> 32U);
    const auto v1 = static_cast<std::uint32_t>(a.edge & 0xFFFFFFFFU);
    const Eigen::Vector3d along = (point(v1) - point(v0)).normalized();
    const auto inwards = [&](const Side& side) {
      for (const std::uint32_t v : triangles_[side.triangle]) {
        if (v == v0 || v == v1) continue;
        const Eigen::Vector3d d = point(v) - point(v0);
        return Eigen::Vector3d(d - along * along.dot(d));
      }
      return Eigen::Vector3d(Eigen::Vector3d::Zero());
    };
    return inwards(a).dot(inwards(b)) < 0.0;
  }

  // A surface's outline as a number: order and winding do not matter.
  void drop_doubles() {
    struct Outline {
      std::uint64_t sum = 0;
      std::uint64_t product = 1;
      std::uint32_t edges = 0;
      std::uint32_t group = 0;
      bool operator<(const Outline& o) const {
        return std::tie(sum, product, edges, group) < std::tie(o.sum, o.product, o.edges, o.group);
      }
      [[nodiscard]] bool same(const Outline& o) const {
        return sum == o.sum && product == o.product && edges == o.edges;
      }
    };
    std::vector<Outline> outlines(seeds_.size());
    for (std::uint32_t g = 0; g < outlines.size(); ++g) outlines[g].group = g;
    std::vector<std::uint32_t> at_edge;
    for (std::size_t i = 0; i < sides_.size();) {
      const std::uint64_t edge = sides_[i].edge;
      at_edge.clear();
      for (; i < sides_.size() && sides_[i].edge == edge; ++i) at_edge.push_back(group_[sides_[i].triangle]);
      std::uint64_t mixed = edge * 0x9E3779B97F4A7C15ULL;
      mixed ^= mixed >> 31U;
      mixed *= 0xBF58476D1CE4E5B9ULL;
      mixed ^= mixed >> 29U;
      std::sort(at_edge.begin(), at_edge.end());
      for (std::size_t k = 0; k < at_edge.size(); ++k) {
        const std::uint32_t group = at_edge[k];
        const bool again = (k > 0 && at_edge[k - 1] == group) || (k + 1 < at_edge.size() && at_edge[k + 1] == group);
        if (again) continue;
        outlines[group].sum += mixed;
        outlines[group].product *= mixed | 1U;
        ++outlines[group].edges;
      }
    }
    std::sort(outlines.begin(), outlines.end());
    dropped_.assign(seeds_.size(), false);
    std::size_t kept = 0;
    for (std::size_t i = 1; i < outlines.size(); ++i) {
      const std::uint32_t own = seeds_[outlines[i].group];
      const bool doubled =
          outlines[i].edges > 0 && outlines[i].same(outlines[i - 1]) && in_plane(own, seeds_[outlines[i - 1].group]);
      dropped_[outlines[i].group] = doubled;
      if (!doubled) kept = i;
      const std::uint32_t first = seeds_[outlines[kept].group];
      if (normals_[own].dot(normals_[first]) < 0.0) given_both_ways_[first] = true;
    }
  }

  void deliver() {
    map_.triangles.clear();
    map_.surfaces.clear();
    for (std::uint32_t g = 0; g < seeds_.size(); ++g) {
      if (dropped_[g]) continue;
      const Eigen::Vector3d& n = normals_[seeds_[g]];
      Surface surface;
      surface.first_triangle = static_cast<std::uint32_t>(map_.triangles.size());
      surface.triangle_count = static_cast<std::uint32_t>(members_[g].size());
      surface.material = materials_[seeds_[g]];
      surface.normal = n.cast<float>();
      surface.offset_m = static_cast<float>(n.dot(point(triangles_[seeds_[g]][0])));
      bool both_ways = false;
      for (const std::uint32_t t : members_[g]) {
        Triangle triangle = triangles_[t];
        const bool turned = normals_[t].dot(n) < 0.0;
        if (turned) std::swap(triangle[1], triangle[2]);
        both_ways = both_ways || turned || given_both_ways_[t];
        map_.triangles.push_back(triangle);
      }
      surface.one_sided = one_sided_ && !both_ways;
      map_.surfaces.push_back(surface);
    }
  }

  const std::vector<Triangle>& triangles_;
  const std::vector<std::uint32_t>& materials_;
  double weld_m_;
  bool one_sided_;
  Map& map_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<double> areas_;
  std::vector<double> heights_;
  std::vector<bool> gone_;
  std::vector<bool> given_both_ways_;  ///< of a triangle: another one that is gone lay there the other way round.
  std::vector<Side> sides_;
  std::vector<std::array<std::uint32_t, 3>> where_;  ///< of each triangle's sides in sides_.
  std::vector<std::uint32_t> group_;
  std::vector<std::uint32_t> seeds_;
  std::vector<std::vector<std::uint32_t>> members_;
  std::vector<bool> dropped_;
};

}  // namespace

Result<void> join(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& materials, double weld_m,
                  bool one_sided, Map& map) {
  return Joiner(triangles, materials, weld_m, one_sided, map).run();
}

}  // namespace cgsr::world
