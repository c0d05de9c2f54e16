#include "pipeline/world/index.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace cgsr::world {
namespace {

constexpr std::uint32_t kEdgesInLeaf = 32;
constexpr std::uint32_t kTrianglesInLeaf = 8;
constexpr int kBorderSteps = 8;

// The range of ideal coordinates that the image covers.
struct IdealRange {
  Eigen::Vector2d low;
  Eigen::Vector2d high;
};

IdealRange range_of(const geometry::Camera& camera) {
  const double right = camera.width_px - 0.5;
  const double bottom = camera.height_px - 0.5;
  IdealRange range{camera.ideal_of({-0.5, -0.5}), camera.ideal_of({right, bottom})};
  if (!camera.has_distortion()) return range;
  const auto add = [&](double u, double v) {
    const Eigen::Vector2d ideal = camera.ideal_of({u, v});
    range.low = range.low.cwiseMin(ideal);
    range.high = range.high.cwiseMax(ideal);
  };
  for (int i = 0; i <= kBorderSteps; ++i) {
    const double s = static_cast<double>(i) / kBorderSteps;
    add(-0.5 + s * (right + 0.5), -0.5);
    add(-0.5 + s * (right + 0.5), bottom);
    add(-0.5, -0.5 + s * (bottom + 0.5));
    add(right, -0.5 + s * (bottom + 0.5));
  }
  return range;
}

Bounds bounds_of(const Map& map, std::span<const std::uint32_t> vertices) {
  Bounds box;
  for (const std::uint32_t v : vertices) box.add(map.vertices[v]);
  return box;
}

// The frustum as a walk over boxes needs it: of each plane the corner that lies deepest inside, by the signs of its normal.
class BoxTest {
 public:
  enum class Answer : std::uint8_t { kOutside, kCrosses, kInside };

  explicit BoxTest(const Frustum& frustum) : frustum_(frustum) {
    for (int plane = 0; plane < 6; ++plane) sizes_.row(plane) = frustum.normals.row(plane).cwiseAbs();
  }

  // `planes`: bits of those that the box may cross; those that it lies inside of are taken out, for its children.
  Answer look(const Tree::Node& node, unsigned& planes) const {
    const float cx = 0.5F * (node.low[0] + node.high[0]);
    const float cy = 0.5F * (node.low[1] + node.high[1]);
    const float cz = 0.5F * (node.low[2] + node.high[2]);
    const float hx = 0.5F * (node.high[0] - node.low[0]);
    const float hy = 0.5F * (node.high[1] - node.low[1]);
    const float hz = 0.5F * (node.high[2] - node.low[2]);
    for (int plane = 0; plane < 6; ++plane) {
      const unsigned bit = 1U << static_cast<unsigned>(plane);
      if ((planes & bit) == 0) continue;
      const float middle = frustum_.normals(plane, 0) * cx + frustum_.normals(plane, 1) * cy +
                           frustum_.normals(plane, 2) * cz - frustum_.offsets[plane];
      const float reach = sizes_(plane, 0) * hx + sizes_(plane, 1) * hy + sizes_(plane, 2) * hz;
      // A little generous: what lies in the plane itself may be seen.
      const float slack = 1e-4F + 1e-6F * std::abs(frustum_.offsets[plane]);
      if (middle + reach < -slack) return Answer::kOutside;
      if (middle - reach >= slack) planes &= ~bit;
    }
    return planes == 0 ? Answer::kInside : Answer::kCrosses;
  }

  [[nodiscard]] float nearest(const Tree::Node& node) const {
    float along = 0.0F;
    for (int i = 0; i < 3; ++i) {
      const float corner = frustum_.forward[i] > 0.0F ? node.low[i] : node.high[i];
      along += frustum_.forward[i] * (corner - frustum_.eye[i]);
    }
    return std::max(0.0F, along);
  }

 private:
  const Frustum& frustum_;
  Eigen::Matrix<float, 6, 3> sizes_;
};

bool cells_in(const Tree& tree, const Frustum& frustum, std::vector<Cell>& cells) {
  cells.clear();
  const auto nodes = tree.nodes();
  if (nodes.empty()) return true;
  const BoxTest test(frustum);
  struct Waiting {
    std::uint32_t node;
    unsigned planes;
  };
  std::array<Waiting, Tree::kDeepest> stack{};
  std::size_t waiting = 0;
  Waiting at{0, 0x3FU};
  for (;;) {
    const Tree::Node& node = nodes[at.node];
    const auto answer = test.look(node, at.planes);
    if (answer == BoxTest::Answer::kCrosses && node.right != 0) {
      // The child that is nearer along the axis that they lie along goes first.
      const std::uint32_t left = at.node + 1;
      const bool left_first = frustum.forward[static_cast<Eigen::Index>(node.axis)] >= 0.0F;
      stack[waiting++] = {left_first ? node.right : left, at.planes};
      at.node = left_first ? left : node.right;
      continue;
    }
    if (answer != BoxTest::Answer::kOutside) {
      if (cells.size() == cells.capacity()) return false;
      cells.push_back({node.first, node.end, test.nearest(node), answer == BoxTest::Answer::kInside});
    }
    if (waiting == 0) return true;
    at = stack[--waiting];
  }
}

// A ray against boxes: slabs. An axis that it does not move along gives infinities, which compare as they should.
class BoxRay {
 public:
  BoxRay(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) : origin_(origin.array()) {
    for (int i = 0; i < 3; ++i) {
      const float d = std::abs(direction[i]) > 1e-12F ? direction[i] : std::copysign(1e-12F, direction[i]);
      inverse_[i] = 1.0F / d;
    }
  }

  [[nodiscard]] bool meets(const Tree::Node& node, float reach, float& enters) const {
    const Eigen::Array3f a = (node.low - origin_) * inverse_;
    const Eigen::Array3f b = (node.high - origin_) * inverse_;
    // A flat box's face and rounding: a little wider than it is.
    enters = std::max(0.0F, a.min(b).maxCoeff() * (1.0F - 1e-6F) - 1e-6F);
    const float leaves = std::min(reach, a.max(b).minCoeff() * (1.0F + 1e-6F) + 1e-6F);
    return enters <= leaves;
  }

 private:
  Eigen::Array3f origin_;
  Eigen::Array3f inverse_;
};

// Moeller and Trumbore's test, in doubles: thin and huge triangles meet here.
std::optional<float> meets(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, const Eigen::Vector3f& a,
                           const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const Eigen::Vector3d ab = (b - a).cast<double>();
  const Eigen::Vector3d ac = (c - a).cast<double>();
  const Eigen::Vector3d d = direction.cast<double>();
  const Eigen::Vector3d p = d.cross(ac);
  const double det = ab.dot(p);
  if (std::abs(det) < 1e-30) return std::nullopt;
  const Eigen::Vector3d from = origin.cast<double>() - a.cast<double>();
  const double u = from.dot(p) / det;
  // Rays along a seam between two triangles must not slip through.
  constexpr double kRim = 1e-7;
  if (u < -kRim || u > 1.0 + kRim) return std::nullopt;
  const Eigen::Vector3d q = from.cross(ab);
  const double v = d.dot(q) / det;
  if (v < -kRim || u + v > 1.0 + kRim) return std::nullopt;
  return static_cast<float>(ac.dot(q) / det);
}

}  // namespace

Frustum::Frustum(const geometry::Pose& X_WC, const geometry::Camera& camera, double near_m, double far_m)
    : eye(X_WC.translation().cast<float>()), forward(X_WC.linear().col(2).cast<float>()) {
  const IdealRange range = range_of(camera);
  const std::array<Eigen::Vector3d, 6> in_C = {
      Eigen::Vector3d(1.0, 0.0, -range.low.x()),
      Eigen::Vector3d(-1.0, 0.0, range.high.x()),
      Eigen::Vector3d(0.0, 1.0, -range.low.y()),
      Eigen::Vector3d(0.0, -1.0, range.high.y()),
      Eigen::Vector3d(0.0, 0.0, 1.0),
      Eigen::Vector3d(0.0, 0.0, -1.0),
  };
  const std::array<double, 6> beyond = {0.0, 0.0, 0.0, 0.0, near_m, -far_m};
  for (int plane = 0; plane < 6; ++plane) {
    const auto i = static_cast<std::size_t>(plane);
    const Eigen::Vector3d normal = X_WC.linear() * in_C[i].normalized();
    normals.row(plane) = normal.cast<float>();
    offsets[plane] = static_cast<float>(normal.dot(X_WC.translation()) + beyond[i]);
  }
}

Tree tree_of_edges(const Map& map) {
  std::vector<Bounds> boxes;
  boxes.reserve(map.edges.size());
  for (const Edge& edge : map.edges) boxes.push_back(bounds_of(map, edge.vertices));
  return {boxes, kEdgesInLeaf};
}

Tree tree_of_triangles(const Map& map) {
  std::vector<Bounds> boxes;
  boxes.reserve(map.triangles.size());
  for (const Triangle& triangle : map.triangles) boxes.push_back(bounds_of(map, triangle));
  return {boxes, kTrianglesInLeaf};
}

Index::Index(const Map& map)
    : map_(&map), edges_(tree_of_edges(map)), triangles_(tree_of_triangles(map)), surface_of_(map.triangles.size()) {
  for (std::size_t s = 0; s < map.surfaces.size(); ++s) {
    const Surface& surface = map.surfaces[s];
    std::fill_n(surface_of_.begin() + surface.first_triangle, surface.triangle_count, static_cast<std::uint32_t>(s));
  }
}

bool Index::edges_in(const Frustum& frustum, std::vector<Cell>& cells) const {
  return cells_in(edges_, frustum, cells);
}

bool Index::triangles_in(const Frustum& frustum, std::vector<Cell>& cells) const {
  return cells_in(triangles_, frustum, cells);
}

std::optional<Hit> Index::first_hit(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float reach_m,
                                    std::span<const std::uint32_t> skip) const {
  const auto nodes = triangles_.nodes();
  if (nodes.empty()) return std::nullopt;
  const BoxRay ray(origin, direction);
  Hit best{reach_m, kNone, kNone};
  std::array<std::uint32_t, Tree::kDeepest> stack{};
  std::size_t waiting = 0;
  std::uint32_t at = 0;
  for (;;) {
    const Tree::Node& node = nodes[at];
    float enters = 0.0F;
    if (ray.meets(node, best.distance_m, enters)) {
      if (node.right != 0) {
        const bool left_first = direction[static_cast<Eigen::Index>(node.axis)] >= 0.0F;
        stack[waiting++] = left_first ? node.right : at + 1;
        at = left_first ? at + 1 : node.right;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.end; ++i) {
        const std::uint32_t triangle = triangles_.order()[i];
        const std::uint32_t surface = surface_of_[triangle];
        if (std::find(skip.begin(), skip.end(), surface) != skip.end()) continue;
        const Triangle& corners = map_->triangles[triangle];
        const auto distance = meets(origin, direction, map_->vertices[corners[0]], map_->vertices[corners[1]],
                                    map_->vertices[corners[2]]);
        if (!distance || *distance < 0.0F || *distance > best.distance_m) continue;
        // Of two at the same place the smaller id, whatever the walk's order.
        if (*distance == best.distance_m && surface >= best.surface) continue;
        best = {*distance, triangle, surface};
      }
    }
    if (waiting == 0) break;
    at = stack[--waiting];
  }
  if (best.surface == kNone) return std::nullopt;
  return best;
}

float Index::free_distance(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float reach_m) const {
  const auto hit = first_hit(origin, direction, reach_m);
  return hit ? hit->distance_m : reach_m;
}

std::optional<Hit> Index::at_pixel(const geometry::Pose& X_WC, const geometry::Camera& camera,
                                   const Eigen::Vector2d& pixel, float reach_m) const {
  const Eigen::Vector3d direction = X_WC.linear() * camera.ideal_of(pixel).homogeneous().normalized();
  return first_hit(X_WC.translation().cast<float>(), direction.cast<float>(), reach_m);
}

std::size_t Index::bytes() const {
  return edges_.bytes() + triangles_.bytes() + surface_of_.size() * sizeof(surface_of_[0]);
}

}  // namespace cgsr::world
