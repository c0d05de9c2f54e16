#include "pipeline/render/surface_raster.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace cgsr::render {
namespace {

using Sphere = SphereGroups::Sphere;

// A floor of ten thousand triangles is in view as a whole, wherever the camera is in the room; of its parts few are.
constexpr std::size_t kTrianglesOfAPart = 64;

// Halves triangles by where they lie until each half is small enough, so that what is near each other stays together.
void split(const world::Map& map, std::span<std::uint32_t> triangles, std::vector<std::span<std::uint32_t>>& parts) {
  if (triangles.size() <= kTrianglesOfAPart) {
    parts.push_back(triangles);
    return;
  }
  const auto middle_of = [&](std::uint32_t name) -> Eigen::Vector3f {
    const world::Triangle& t = map.triangles[name];
    return map.vertices[t[0]] + map.vertices[t[1]] + map.vertices[t[2]];
  };
  Eigen::AlignedBox3f box;
  for (const std::uint32_t name : triangles) box.extend(middle_of(name));
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t half = triangles.size() / 2;
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half), triangles.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return middle_of(a)[axis] < middle_of(b)[axis]; });
  split(map, triangles.first(half), parts);
  split(map, triangles.subspan(half), parts);
}

std::vector<Sphere> spheres_of(const world::Map& map, std::span<const std::uint32_t> order,
                               std::span<const SurfaceRaster::Part> parts) {
  std::vector<Sphere> spheres;
  spheres.reserve(parts.size());
  for (const SurfaceRaster::Part& part : parts) {
    Eigen::AlignedBox3f box;
    for (const std::uint32_t name : order.subspan(part.first, part.count)) {
      for (const std::uint32_t v : map.triangles[name]) box.extend(map.vertices[v]);
    }
    spheres.push_back({box.center(), 0.5F * box.diagonal().norm(), part.count});
  }
  return spheres;
}

}  // namespace

std::vector<SurfaceRaster::Part> SurfaceRaster::parts_of(const world::Map& map, std::vector<std::uint32_t>& order) {
  order.resize(map.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<Part> parts;
  parts.reserve(map.surfaces.size());
  std::vector<std::span<std::uint32_t>> pieces;
  for (std::uint32_t name = 0; name < map.surfaces.size(); ++name) {
    const world::Surface& surface = map.surfaces[name];
    if (surface.triangle_count == 0) continue;
    pieces.clear();
    split(map, std::span(order).subspan(surface.first_triangle, surface.triangle_count), pieces);
    for (const auto& piece : pieces) {
      parts.push_back(
          {name, static_cast<std::uint32_t>(piece.data() - order.data()), static_cast<std::uint32_t>(piece.size())});
    }
  }
  return parts;
}

SurfaceRaster::SurfaceRaster(const world::Map& map, const RasterParameters& parameters)
    : map_(map),
      parameters_(parameters),
      parts_(parts_of(map, order_)),
      in_view_(spheres_of(map, order_, parts_),
               {.max_visited = parameters.max_visited,
                .max_chosen = parameters.max_surfaces,
                .max_weight = parameters.max_triangles},
               Preference::kNearest),
      corners_(map.vertices.size()),
      planes_(map.surfaces.size()),
      front_(map.surfaces.size()),
      surface_of_(map.triangles.size(), world::kNone) {
  for (std::uint32_t name = 0; name < map.surfaces.size(); ++name) {
    const world::Surface& surface = map.surfaces[name];
    for (std::uint32_t t = 0; t < surface.triangle_count; ++t) surface_of_[surface.first_triangle + t] = name;
  }
}

void SurfaceRaster::place(const geometry::Pose& X_WC, const View& view) {
  view_ = &view;
  frustum_ = frustum_of(X_WC, *view_, parameters_.near_m);
  R_CW_ = X_WC.linear().transpose().cast<float>();
  p_WC_ = X_WC.translation().cast<float>();
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  K << view_->fx, 0.0, view_->cx, 0.0, view_->fy, view_->cy, 0.0, 0.0, 1.0;
  to_cells_ = (K * X_WC.linear().transpose()).cast<float>();
  if (++look_ == 0) {  // after 2^32 looks
    for (Corner& each : corners_) each.look = 0;
    look_ = 1;
  }
}

const ViewedCorner& SurfaceRaster::corner(std::uint32_t vertex) {
  Corner& found = corners_[vertex];
  if (found.look == look_) return found;
  found.look = look_;
  found.set(to_cells_ * (map_.vertices[vertex] - p_WC_), static_cast<float>(parameters_.near_m));
  return found;
}

void SurfaceRaster::draw(const geometry::Pose& X_WC, const View& view, DepthBuffer& buffer) {
  place(X_WC, view);
  buffer.clear();
  const double min_surface = 0.5 * parameters_.min_surface_cells / std::max(view_->fx, view_->fy);
  for (const std::uint32_t chosen : in_view_.select(frustum_, min_surface)) {
    const Part& part = parts_[chosen];
    const std::uint32_t name = part.surface;
    const world::Surface& surface = map_.surfaces[name];
    if (!is_seen_from(surface, p_WC_) || !plane_in_view(surface.normal, surface.offset_m, planes_[name])) continue;
    const DepthPlane& plane = planes_[name];
    front_[name] = surface.normal.dot(p_WC_) > surface.offset_m ? 1 : 0;
    for (const std::uint32_t index : std::span(order_).subspan(part.first, part.count)) {
      const world::Triangle& triangle = map_.triangles[index];
      const std::array<const ViewedCorner*, 3> c = {&corner(triangle[0]), &corner(triangle[1]), &corner(triangle[2])};
      if (c[0]->w > 0.0F && c[1]->w > 0.0F && c[2]->w > 0.0F) {
        buffer.draw(c[0]->at, c[1]->at, c[2]->at, plane, index);
      } else if (c[0]->w > 0.0F || c[1]->w > 0.0F || c[2]->w > 0.0F) {
        draw_clipped(c, plane, index, buffer);
      }
    }
  }
}

/// n_C . p_C = d with p_C = Z ((u - cx) / fx, (v - cy) / fy, 1) gives 1/Z = n_C . (...) / d, linear in u and v.
bool SurfaceRaster::plane_in_view(const Eigen::Vector3f& normal, float offset_m, DepthPlane& plane) const {
  const float d = offset_m - normal.dot(p_WC_);
  if (std::abs(d) < 1e-5F) return false;
  const Eigen::Vector3f n_C = R_CW_ * (normal / d);
  plane.du = n_C.x() / static_cast<float>(view_->fx);
  plane.dv = n_C.y() / static_cast<float>(view_->fy);
  plane.at_origin = n_C.z() - plane.du * static_cast<float>(view_->cx) - plane.dv * static_cast<float>(view_->cy);
  return true;
}

bool SurfaceRaster::may_be_in_view(const std::array<Eigen::Vector3f, 4>& corners) const {
  constexpr float kSpare = 1.0F;
  const auto near = static_cast<float>(parameters_.near_m);
  const float right = static_cast<float>(view_->width) + kSpare;
  const float below = static_cast<float>(view_->height) + kSpare;
  int behind = 0;
  int to_left = 0;
  int to_right = 0;
  int above = 0;
  int beneath = 0;
  for (const Eigen::Vector3f& corner : corners) {
    const Eigen::Vector3f p = to_cells_ * (corner - p_WC_);
    behind += p.z() < near ? 1 : 0;
    to_left += p.x() < -kSpare * p.z() ? 1 : 0;
    to_right += p.x() > right * p.z() ? 1 : 0;
    above += p.y() < -kSpare * p.z() ? 1 : 0;
    beneath += p.y() > below * p.z() ? 1 : 0;
  }
  return behind < 4 && to_left < 4 && to_right < 4 && above < 4 && beneath < 4;
}

void SurfaceRaster::mark(const std::array<Eigen::Vector3f, 4>& corners, const DepthPlane& plane, float lift,
                         const DepthBuffer& buffer, std::uint8_t bits, std::vector<std::uint8_t>& mask) const {
  const auto near = static_cast<float>(parameters_.near_m);
  std::array<Eigen::Vector3f, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = to_cells_ * (corners[i] - p_WC_);
  std::array<Eigen::Vector2f, 6> kept;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3f& a = p[i];
    const Eigen::Vector3f& b = p[(i + 1) % 4];
    if (a.z() >= near) kept[count++] = a.head<2>() / a.z();
    if ((a.z() >= near) == (b.z() >= near)) continue;
    const float t = (near - a.z()) / (b.z() - a.z());
    kept[count++] = (a + t * (b - a)).head<2>() / near;
  }
  const DepthPlane lowered{plane.du / lift, plane.dv / lift, plane.at_origin / lift};
  for (std::size_t i = 2; i < count; ++i) buffer.mark(kept[0], kept[i - 1], kept[i], lowered, bits, mask.data());
}

/// Cuts a triangle at the near plane (Sutherland and Hodgman): three or four corners are left.
void SurfaceRaster::draw_clipped(const std::array<const ViewedCorner*, 3>& corners, const DepthPlane& plane,
                                 std::uint32_t triangle, DepthBuffer& buffer) const {
  const auto near = static_cast<float>(parameters_.near_m);
  std::array<Eigen::Vector2f, 4> kept;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const ViewedCorner& a = *corners[i];
    const ViewedCorner& b = *corners[(i + 1) % 3];
    if (a.w > 0.0F) kept[count++] = a.at;
    if ((a.w > 0.0F) == (b.w > 0.0F)) continue;
    const float t = (near - a.p.z()) / (b.p.z() - a.p.z());
    kept[count++] = (a.p + t * (b.p - a.p)).head<2>() / near;
  }
  for (std::size_t i = 2; i < count; ++i) buffer.draw(kept[0], kept[i - 1], kept[i], plane, triangle);
}

bool SurfaceRaster::covers(std::uint32_t triangle, float u, float v) const {
  const world::Triangle& t = map_.triangles[triangle];
  const Corner& a = corners_[t[0]];
  const Corner& b = corners_[t[1]];
  const Corner& c = corners_[t[2]];
  if (a.w == 0.0F || b.w == 0.0F || c.w == 0.0F) {
    // It reaches behind the near plane: the ray through the place is a sum of the corners' own, none of them taken away, or it passes by.
    const Eigen::Vector3f ray(u, v, 1.0F);
    const float whole = a.p.cross(b.p).dot(c.p);
    const float sign = whole < 0.0F ? -1.0F : 1.0F;
    return sign * ray.dot(b.p.cross(c.p)) >= 0.0F && sign * ray.dot(c.p.cross(a.p)) >= 0.0F &&
           sign * ray.dot(a.p.cross(b.p)) >= 0.0F;
  }
  const auto side = [&](const Corner& from, const Corner& to) {
    return (to.at.x() - from.at.x()) * (v - from.at.y()) - (to.at.y() - from.at.y()) * (u - from.at.x());
  };
  const float ab = side(a, b);
  const float bc = side(b, c);
  if ((ab > 0.0F && bc < 0.0F) || (ab < 0.0F && bc > 0.0F)) return false;
  const float ca = side(c, a);
  return ab + bc >= 0.0F ? ca >= 0.0F && ab >= 0.0F && bc >= 0.0F : ca <= 0.0F;
}

}  // namespace cgsr::render
