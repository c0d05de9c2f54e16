#include "pipeline/localization/expected.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

namespace cgsr::localization {
namespace {

constexpr float kNear_m = 0.05F;
constexpr float kLeastLength_px = 6.0F;
constexpr float kSeenToItsEnd_px = 1.5F;  // no more of an edge is missing than the expectation's raster leaves out
constexpr float kBorder_px = 2.0F;        // edges are not found nearer to the image's border

// Of one illumination on both sides, or not: then a crease's light may differ by this factor on its own.
constexpr float kLeastRatioFlat = 1.25F;
constexpr float kLeastRatioCrease = 2.5F;
constexpr float kSurelySeenContrast = 0.12F;  // encoded luma
constexpr float kLeastWeight = 0.25F;
// Where light makes the contrast, or what is behind is not known, the map cannot tell how much there is: such edges are found as often
// where it says a little as where it says a lot.
constexpr float kUnknownWeight = 0.6F;

float linear(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

float luminance(const Eigen::Vector3f& color) {
  return 0.2126F * linear(color[0]) + 0.7152F * linear(color[1]) + 0.0722F * linear(color[2]);
}

bool inside(const world::Map& map, const world::Surface& surface, const Eigen::Vector3f& p) {
  for (std::uint32_t i = 0; i < surface.triangle_count; ++i) {
    const world::Triangle& triangle = map.triangles[surface.first_triangle + i];
    bool within = true;
    for (std::size_t k = 0; k < 3 && within; ++k) {
      const Eigen::Vector3f& a = map.vertices[triangle[k]];
      const Eigen::Vector3f& b = map.vertices[triangle[(k + 1) % 3]];
      within = (b - a).cross(p - a).dot(surface.normal) >= -1e-6F;
    }
    if (within) return true;
  }
  return false;
}

// Which way a surface lies from an edge: the one that is inside of it. Where both are (a box on a floor), the one that leads the way that
// `hint` does.
Eigen::Vector3f inward_of(const world::Map& map, const world::Edge& edge, std::uint32_t surface_index,
                          const Eigen::Vector3f& hint) {
  const world::Surface& surface = map.surfaces[surface_index];
  const Eigen::Vector3f& a = map.vertices[edge.vertices[0]];
  const Eigen::Vector3f& b = map.vertices[edge.vertices[1]];
  const float length = (b - a).norm();
  if (!(length > 0.0F)) return Eigen::Vector3f::Zero();
  Eigen::Vector3f across = surface.normal.cross((b - a) / length);
  if (across.dot(hint) < 0.0F) across = -across;
  // Large surfaces of many triangles are believed to lie as hinted, without a look.
  if (surface.triangle_count > 2000) return across;
  const float step = std::min(0.002F, 0.05F * length);
  const Eigen::Vector3f middle = 0.5F * (a + b);
  if (!inside(map, surface, middle + step * across) && inside(map, surface, middle - step * across)) return -across;
  return across;
}

struct Clipped {
  Eigen::Vector2f p0;
  Eigen::Vector2f p1;
  float from;
  float to;
  float depth0_m;
  float depth1_m;
};

// A line in space to its part inside of the image, shrunk by `border`; `from` and `to` are places on the line in space.
std::optional<Clipped> clipped(const Eigen::Vector3f& c0, const Eigen::Vector3f& c1, const geometry::Camera& camera,
                               float border) {
  float from = 0.0F;
  float to = 1.0F;
  const Eigen::Vector3f d = c1 - c0;
  // Inside is where a(t) = g(c0) + t g(d) >= 0, for five linear functions g: near plane and the image's four sides.
  const auto fx = static_cast<float>(camera.fx_px);
  const auto fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px);
  const auto cy = static_cast<float>(camera.cy_px);
  const float right = static_cast<float>(camera.width_px) - 0.5F - border;
  const float bottom = static_cast<float>(camera.height_px) - 0.5F - border;
  const float left = -0.5F + border;
  const std::array<float, 5> g0 = {c0.z() - kNear_m, fx * c0.x() + (cx - left) * c0.z(),
                                   (right - cx) * c0.z() - fx * c0.x(), fy * c0.y() + (cy - left) * c0.z(),
                                   (bottom - cy) * c0.z() - fy * c0.y()};
  const std::array<float, 5> gd = {d.z(), fx * d.x() + (cx - left) * d.z(), (right - cx) * d.z() - fx * d.x(),
                                   fy * d.y() + (cy - left) * d.z(), (bottom - cy) * d.z() - fy * d.y()};
  for (std::size_t i = 0; i < g0.size(); ++i) {
    const float end = g0[i] + gd[i];
    if (g0[i] < 0.0F && end < 0.0F) return std::nullopt;
    if (g0[i] < 0.0F) {
      from = std::max(from, -g0[i] / gd[i]);
    } else if (end < 0.0F) {
      to = std::min(to, -g0[i] / gd[i]);
    }
  }
  if (from >= to) return std::nullopt;
  const Eigen::Vector3f a = c0 + from * d;
  const Eigen::Vector3f b = c0 + to * d;
  return Clipped{.p0 = {fx * a.x() / a.z() + cx, fy * a.y() / a.z() + cy},
                 .p1 = {fx * b.x() / b.z() + cx, fy * b.y() / b.z() + cy},
                 .from = from,
                 .to = to,
                 .depth0_m = a.z(),
                 .depth1_m = b.z()};
}

}  // namespace

std::vector<EdgeSides> sides_of(const world::Map& map) {
  std::vector<EdgeSides> result(map.edges.size());
  for (std::size_t i = 0; i < map.edges.size(); ++i) {
    const world::Edge& edge = map.edges[i];
    EdgeSides& sides = result[i];
    sides.weight = std::clamp(edge.contrast / kSurelySeenContrast, kLeastWeight, 1.0F);
    if (edge.sides[0] == world::kNone || edge.sides[1] == world::kNone) {
      sides.weight = kUnknownWeight;
      continue;
    }
    const world::Surface& s0 = map.surfaces[edge.sides[0]];
    const world::Surface& s1 = map.surfaces[edge.sides[1]];
    const world::Material& m0 = map.materials[s0.material];
    const world::Material& m1 = map.materials[s1.material];
    const bool flat = std::abs(s0.normal.dot(s1.normal)) > 0.999F;
    if (!m0.known_color || !m1.known_color || (!flat && s0.material == s1.material)) sides.weight = kUnknownWeight;
    if (!m0.known_color || !m1.known_color) continue;
    const float ratio = (luminance(m0.color) + 0.01F) / (luminance(m1.color) + 0.01F);
    const float least = flat ? kLeastRatioFlat : kLeastRatioCrease;
    if (ratio > least) sides.brighter = 0;
    if (ratio < 1.0F / least) sides.brighter = 1;
    if (sides.brighter < 0) continue;
    // An adjacent surface lies as Edge says; what covers the other side, or lies under it, on that side of the edge and in front.
    const Eigen::Vector3f up = map.vertices[edge.vertices[1]] - map.vertices[edge.vertices[0]];
    const std::size_t own = edge.sides[0] == edge.surfaces[0] || edge.sides[1] != edge.surfaces[1] ? 0 : 1;
    const std::size_t other = 1 - own;
    const Eigen::Vector3f normal = map.surfaces[edge.sides[own]].normal;
    const Eigen::Vector3f left = normal.cross(up).normalized();
    sides.inward[own] = inward_of(map, edge, edge.sides[own], own == 0 ? left : Eigen::Vector3f(-left));
    sides.inward[other] =
        inward_of(map, edge, edge.sides[other],
                  edge.sides[other] == edge.surfaces[other] ? Eigen::Vector3f(-sides.inward[own])
                                                            : Eigen::Vector3f(normal - sides.inward[own]));
  }
  return result;
}

ExpectedView::ExpectedView(const world::Map& map, std::size_t most_pieces)
    : map_(&map), sides_(sides_of(map)), most_(most_pieces) {
  pieces_.reserve(most_);
  projected_.reserve(most_);
}

void ExpectedView::take(std::span<const render::VisiblePiece> visible, const geometry::Pose& X_WC) {
  pieces_.clear();
  const Eigen::Vector3f forward = X_WC.linear().col(2).cast<float>();
  const Eigen::Vector3f p_WC = X_WC.translation().cast<float>();
  for (const render::VisiblePiece& piece : visible) {
    if (pieces_.size() == most_) break;
    const world::Edge& edge = map_->edges[piece.edge];
    const Eigen::Vector3f& a = map_->vertices[edge.vertices[0]];
    const Eigen::Vector3f& b = map_->vertices[edge.vertices[1]];
    // A stretch from place s to t of the edge is (t - s) / (Z_s Z_t) long in the image, but for a factor that all of its stretches share.
    const float seen_px = (piece.p1 - piece.p0).norm() / std::max(1e-6F, piece.to - piece.from);
    const float depth_a = forward.dot(a - p_WC);
    const float depth_b = forward.dot(b - p_WC);
    const float depth_from = depth_a + piece.from * (depth_b - depth_a);
    const float depth_to = depth_a + piece.to * (depth_b - depth_a);
    const bool ends_at_p0 = depth_a > kNear_m && piece.from * seen_px * depth_to < kSeenToItsEnd_px * depth_a;
    const bool ends_at_p1 = depth_b > kNear_m && (1.0F - piece.to) * seen_px * depth_from < kSeenToItsEnd_px * depth_b;
    pieces_.push_back({.edge = piece.edge,
                       .p0_W = a + (ends_at_p0 ? 0.0F : piece.from) * (b - a),
                       .p1_W = a + (ends_at_p1 ? 1.0F : piece.to) * (b - a),
                       .ends_at_p0 = ends_at_p0,
                       .ends_at_p1 = ends_at_p1});
  }
}

void ExpectedView::project(const geometry::Pose& X_WC, const geometry::Camera& camera) {
  projected_.clear();
  const Eigen::Matrix3f R_CW = X_WC.linear().transpose().cast<float>();
  const Eigen::Vector3f t = X_WC.translation().cast<float>();
  const auto fx = static_cast<float>(camera.fx_px);
  const auto fy = static_cast<float>(camera.fy_px);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const ExpectedPiece& piece = pieces_[i];
    const Eigen::Vector3f c0 = R_CW * (piece.p0_W - t);
    const Eigen::Vector3f c1 = R_CW * (piece.p1_W - t);
    const auto part = clipped(c0, c1, camera, kBorder_px);
    if (!part) continue;
    const Eigen::Vector2f d = part->p1 - part->p0;
    const float length = d.norm();
    if (!(length >= kLeastLength_px)) continue;
    ProjectedPiece seen;
    seen.piece = static_cast<std::uint32_t>(i);
    seen.middle = 0.5F * (part->p0 + part->p1);
    seen.direction = d / length;
    seen.half_length = 0.5F * length;
    seen.from = part->from;
    seen.to = part->to;
    seen.depth0_m = part->depth0_m;
    seen.depth1_m = part->depth1_m;
    const EdgeSides& sides = sides_[piece.edge];
    seen.weight = sides.weight;
    if (sides.brighter >= 0) {
      // Where a step along each surface, away from the edge, leads in the image. Both to one side: an outline, and what is behind it is
      // another surface.
      const Eigen::Vector3f middle = c0 + 0.5F * (part->from + part->to) * (c1 - c0);
      const auto side_of = [&](const Eigen::Vector3f& inward) {
        const Eigen::Vector3f m = R_CW * inward;
        const float du = fx * (m.x() * middle.z() - middle.x() * m.z());
        const float dv = fy * (m.y() * middle.z() - middle.y() * m.z());
        return -seen.direction.y() * du + seen.direction.x() * dv;
      };
      const float s0 = side_of(sides.inward[0]);
      const float s1 = side_of(sides.inward[1]);
      if (s0 * s1 < 0.0F) {
        const float bright = sides.brighter == 0 ? s0 : s1;
        seen.bright_side = bright > 0.0F ? std::int8_t{1} : std::int8_t{-1};
      }
    }
    projected_.push_back(seen);
  }
}

Eigen::Vector3d ExpectedView::point_at(const ProjectedPiece& piece, float along) const {
  // 1/z is linear in the image, so the place in space is not the place in the image.
  const float s = (along + piece.half_length) / (2.0F * piece.half_length);
  const float t = s * piece.depth0_m / ((1.0F - s) * piece.depth1_m + s * piece.depth0_m);
  const float place = piece.from + t * (piece.to - piece.from);
  const ExpectedPiece& source = pieces_[piece.piece];
  return (source.p0_W + place * (source.p1_W - source.p0_W)).cast<double>();
}

void EveryEdge::look(const geometry::Pose& X_WC, const geometry::Camera& camera,
                     std::vector<render::VisiblePiece>& pieces) {
  pieces.clear();
  const Eigen::Matrix3f R_CW = X_WC.linear().transpose().cast<float>();
  const Eigen::Vector3f t = X_WC.translation().cast<float>();
  for (std::size_t i = 0; i < map_->edges.size() && pieces.size() < pieces.capacity(); ++i) {
    const world::Edge& edge = map_->edges[i];
    const Eigen::Vector3f c0 = R_CW * (map_->vertices[edge.vertices[0]] - t);
    const Eigen::Vector3f c1 = R_CW * (map_->vertices[edge.vertices[1]] - t);
    const auto part = clipped(c0, c1, camera, 0.0F);
    if (!part) continue;
    pieces.push_back(
        {.edge = static_cast<std::uint32_t>(i), .from = part->from, .to = part->to, .p0 = part->p0, .p1 = part->p1});
  }
}

}  // namespace cgsr::localization
