#include "pipeline/world/beside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include "pipeline/world/index.h"

namespace cgsr::world {
namespace {

constexpr float kUnknownContrast = 0.25F;
constexpr float kShading = 0.25F;
constexpr float kParallel = 0.7F;
// Off regular grids, so that a pattern below does not answer for all of the edge; the middle first.
constexpr std::array<float, 5> kPlaces = {0.52F, 0.13F, 0.88F, 0.31F, 0.69F};
constexpr std::size_t kEnough = 3;

class Looker {
 public:
  Looker(const Map& map, double lies_on_m)
      : map_(map),
        index_(map),
        reach_m_(static_cast<float>(lies_on_m)),
        aside_m_(0.25F * static_cast<float>(lies_on_m)) {}

  void fill(Edge& edge) const {
    edge.sides = edge.surfaces;
    if (edge.kind == EdgeKind::kBorder) border(edge);
    if (edge.kind == EdgeKind::kCrease) crease(edge);
  }

 private:
  struct Frame {
    Eigen::Vector3f start;
    Eigen::Vector3f along;                   ///< from end to end.
    std::array<Eigen::Vector3f, 2> inwards;  ///< into surfaces[0] and surfaces[1], unit, in their planes.
    std::array<Eigen::Vector3f, 2> normals;
  };

  [[nodiscard]] Frame frame_of(const Edge& edge) const {
    Frame frame;
    frame.start = map_.vertices[edge.vertices[0]];
    frame.along = map_.vertices[edge.vertices[1]] - frame.start;
    const Eigen::Vector3f unit = frame.along.normalized();
    frame.normals[0] = map_.surfaces[edge.surfaces[0]].normal;
    frame.inwards[0] = frame.normals[0].cross(unit);
    frame.normals[1] = frame.normals[0];
    frame.inwards[1] = -frame.inwards[0];
    if (edge.surfaces[1] == kNone) return frame;
    // The second surface may be wound either way: into it is where it lies.
    frame.normals[1] = map_.surfaces[edge.surfaces[1]].normal;
    frame.inwards[1] = frame.normals[1].cross(unit);
    if (!lies_towards(edge.surfaces[1], edge, frame.inwards[1])) frame.inwards[1] = -frame.inwards[1];
    return frame;
  }

  // Does the surface, a neighbour of the edge, lie on this side of it? One of its triangles has the edge, or a part of it, as its side.
  [[nodiscard]] bool lies_towards(std::uint32_t surface, const Edge& edge, const Eigen::Vector3f& direction) const {
    const Surface& s = map_.surfaces[surface];
    const Eigen::Vector3f a = map_.vertices[edge.vertices[0]];
    const Eigen::Vector3f b = map_.vertices[edge.vertices[1]];
    const Eigen::Vector3f probe = 0.5F * (a + b);
    const Eigen::Vector3f lift = 1e-4F * s.normal;
    const float step = std::min(0.05F * (b - a).norm(), aside_m_);
    for (const float sign : {1.0F, -1.0F}) {
      const Eigen::Vector3f q = probe + sign * step * direction;
      const auto hit = index_.first_hit(q + lift, -s.normal, 2e-4F);
      if (hit && hit->surface == surface) return sign > 0.0F;
    }
    return true;
  }

  // The nearest surface along +-normal of a point, of those that are about parallel.
  [[nodiscard]] std::uint32_t under(const Eigen::Vector3f& p, const Eigen::Vector3f& normal, const Edge& edge) const {
    Hit best;
    best.distance_m = reach_m_;
    for (const float sign : {1.0F, -1.0F}) {
      const Eigen::Vector3f direction = sign * normal;
      const auto hit = index_.first_hit(p - 1e-4F * direction, direction, best.distance_m, edge.surfaces);
      if (hit && std::abs(map_.surfaces[hit->surface].normal.dot(normal)) > kParallel) best = *hit;
    }
    return best.surface;
  }

  // What most of the places say. `find` takes a point of the edge.
  template <class Find>
  [[nodiscard]] std::uint32_t vote(const Frame& frame, const Find& find) const {
    std::array<std::uint32_t, kPlaces.size()> found{};
    std::size_t misses = 0;
    for (std::size_t i = 0; i < kPlaces.size(); ++i) {
      found[i] = find(Eigen::Vector3f(frame.start + kPlaces[i] * frame.along));
      misses += found[i] == kNone ? 1 : 0;
      if (misses >= kEnough || (i == 0 && misses == 1)) return kNone;
    }
    std::sort(found.begin(), found.end());
    std::uint32_t most = kNone;
    std::ptrdiff_t votes = 0;
    for (const std::uint32_t surface : found) {
      const std::ptrdiff_t here = std::count(found.begin(), found.end(), surface);
      if (surface == kNone || here <= votes) continue;
      most = surface;
      votes = here;
    }
    return most;
  }

  void border(Edge& edge) const {
    const Frame frame = frame_of(edge);
    const Eigen::Vector3f out = -frame.inwards[0];
    edge.sides[1] = vote(frame, [&](const Eigen::Vector3f& p) {
      const std::uint32_t below = under(p + aside_m_ * out, frame.normals[0], edge);
      if (below != kNone) return below;
      const auto ahead = index_.first_hit(p - 1e-4F * out, out, reach_m_, edge.surfaces);
      return ahead ? ahead->surface : kNone;
    });
  }

  // From outside of the fold a side may be covered: a box's bottom by the floor, a cupboard's back by the wall. Then what covers it is seen
  // beside the edge, if it goes on there.
  void crease(Edge& edge) const {
    const Frame frame = frame_of(edge);
    const Eigen::Vector3f outside = -(frame.inwards[0] + frame.inwards[1]);
    for (std::size_t side = 0; side < 2; ++side) {
      const Eigen::Vector3f& into = frame.inwards[side];
      Eigen::Vector3f normal = frame.normals[side];
      if (normal.dot(outside) < 0.0F) normal = -normal;
      const std::uint32_t cover = vote(frame, [&](const Eigen::Vector3f& p) {
        const Eigen::Vector3f q = p + aside_m_ * into;
        const auto hit = index_.first_hit(q - 1e-4F * normal, normal, reach_m_, edge.surfaces);
        return hit && std::abs(map_.surfaces[hit->surface].normal.dot(normal)) > kParallel ? hit->surface : kNone;
      });
      if (cover == kNone) continue;
      edge.sides[side] =
          vote(frame, [&](const Eigen::Vector3f& p) { return under(p - aside_m_ * into, normal, edge); });
    }
  }

  const Map& map_;
  Index index_;
  float reach_m_;
  float aside_m_;
};

}  // namespace

float expected_contrast(const Map& map, const Edge& edge) {
  const auto left = side_luma(map, edge, 0);
  const auto right = side_luma(map, edge, 1);
  if (!left || !right) return kUnknownContrast;
  const float sine = map.surfaces[edge.sides[0]].normal.cross(map.surfaces[edge.sides[1]].normal).norm();
  return std::hypot(*left - *right, kShading * 0.5F * (*left + *right) * std::min(1.0F, sine));
}

void look_beside(double lies_on_m, Map& map) {
  std::vector<Edge> edges;
  edges.swap(map.edges);  // rays need the surfaces alone
  const Looker looker(map, lies_on_m);
  for (Edge& edge : edges) {
    if (edge.kind != EdgeKind::kDrawn) looker.fill(edge);
    edge.contrast = expected_contrast(map, edge);
  }
  map.edges.swap(edges);
}

}  // namespace cgsr::world
