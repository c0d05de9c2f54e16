#include "pipeline/render/depth_raster.h"

#include <algorithm>
#include <cmath>

namespace cgsr::render {
namespace {

using Sphere = SphereGroups::Sphere;

std::vector<Sphere> spheres_of_surfaces(const world::Map& map) {
  std::vector<Sphere> spheres;
  spheres.reserve(map.surfaces.size());
  for (const world::Surface& surface : map.surfaces) {
    Eigen::AlignedBox3f box;
    for (std::uint32_t t = 0; t < surface.triangle_count; ++t) {
      for (const std::uint32_t v : map.triangles[surface.first_triangle + t]) box.extend(map.vertices[v]);
    }
    if (box.isEmpty()) {
      spheres.push_back({});
    } else {
      spheres.push_back({box.center(), 0.5F * box.diagonal().norm()});
    }
  }
  return spheres;
}

std::vector<Sphere> spheres_of_edges(const world::Map& map) {
  std::vector<Sphere> spheres;
  spheres.reserve(map.edges.size());
  for (const world::Edge& edge : map.edges) {
    const Eigen::Vector3f& a = map.vertices[edge.vertices[0]];
    const Eigen::Vector3f& b = map.vertices[edge.vertices[1]];
    spheres.push_back({0.5F * (a + b), 0.5F * (b - a).norm()});
  }
  return spheres;
}

}  // namespace

DepthRaster::DepthRaster(const world::Map& map, const RasterParameters& parameters)
    : map_(map),
      parameters_(parameters),
      views_(parameters.width, parameters.height),
      view_(&views_.of(geometry::Camera())),
      surfaces_(spheres_of_surfaces(map), parameters.looked_at_most, parameters.surfaces_most),
      edges_(spheres_of_edges(map), parameters.looked_at_most, parameters.edges_most),
      buffer_(parameters.width, parameters.height),
      corners_(map.vertices.size()),
      planes_(map.surfaces.size()),
      surface_of_(map.triangles.size(), world::kNone) {
  for (std::uint32_t name = 0; name < map.surfaces.size(); ++name) {
    const world::Surface& surface = map.surfaces[name];
    for (std::uint32_t t = 0; t < surface.triangle_count; ++t) surface_of_[surface.first_triangle + t] = name;
  }
  // An edge that is crossed by many things falls into many pieces, but few do.
  found_.reserve(2 * std::min(map.edges.size(), static_cast<std::size_t>(parameters.edges_most)) + 64);
  lengths_.reserve(found_.capacity());
}

void DepthRaster::look(const geometry::Pose& X_WC, const geometry::Camera& camera, std::vector<VisiblePiece>& pieces) {
  pieces.clear();
  if (pieces.capacity() == 0) pieces.reserve(static_cast<std::size_t>(parameters_.pieces_most));
  draw(X_WC, camera);
  found_.clear();
  // Spheres are told by their radius over their distance.
  const double least_edge = 0.5 * parameters_.piece_least_px / std::max(camera.fx_px, camera.fy_px);
  for (const std::uint32_t edge : edges_.select(frustum_, least_edge)) look_at_edge(edge);
  keep_longest(std::min(pieces.capacity(), static_cast<std::size_t>(parameters_.pieces_most)));
  const auto earlier = [](const VisiblePiece& a, const VisiblePiece& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.from < b.from;
  };
  if (!std::is_sorted(found_.begin(), found_.end(), earlier)) std::sort(found_.begin(), found_.end(), earlier);
  pieces.insert(pieces.end(), found_.begin(), found_.end());
}

void DepthRaster::draw(const geometry::Pose& X_WC, const geometry::Camera& camera) {
  place(X_WC, camera);
  draw_surfaces();
}

void DepthRaster::place(const geometry::Pose& X_WC, const geometry::Camera& camera) {
  view_ = &views_.of(camera);
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

const DepthRaster::Corner& DepthRaster::corner(std::uint32_t vertex) {
  Corner& found = corners_[vertex];
  if (found.look == look_) return found;
  found.look = look_;
  found.set(to_cells_ * (map_.vertices[vertex] - p_WC_), static_cast<float>(parameters_.near_m));
  return found;
}

void DepthRaster::draw_surfaces() {
  buffer_.clear();
  int triangles_left = parameters_.triangles_most;
  const double least_surface = 0.5 * parameters_.surface_least_cells / std::max(view_->fx, view_->fy);
  for (const std::uint32_t name : surfaces_.select(frustum_, least_surface)) {
    const world::Surface& surface = map_.surfaces[name];
    if (!set_plane(name)) continue;
    const DepthPlane& plane = planes_[name];
    triangles_left -= static_cast<int>(surface.triangle_count);
    if (triangles_left < 0) break;
    for (std::uint32_t t = 0; t < surface.triangle_count; ++t) {
      const std::uint32_t index = surface.first_triangle + t;
      const world::Triangle& triangle = map_.triangles[index];
      const std::array<const Corner*, 3> c = {&corner(triangle[0]), &corner(triangle[1]), &corner(triangle[2])};
      if (c[0]->w > 0.0F && c[1]->w > 0.0F && c[2]->w > 0.0F) {
        buffer_.draw(c[0]->at, c[1]->at, c[2]->at, plane, index);
      } else if (c[0]->w > 0.0F || c[1]->w > 0.0F || c[2]->w > 0.0F) {
        draw_clipped(c, plane, index);
      }
    }
  }
}

/// n_C . p_C = d with p_C = Z ((u - cx) / fx, (v - cy) / fy, 1) gives 1/Z = n_C . (...) / d, linear in u and v.
///
/// \return whether the plane can be seen at all; not when it passes through the camera.
bool DepthRaster::set_plane(std::uint32_t surface) {
  const world::Surface& s = map_.surfaces[surface];
  const float d = s.offset_m - s.normal.dot(p_WC_);
  if (std::abs(d) < 1e-5F) return false;
  const Eigen::Vector3f n_C = R_CW_ * (s.normal / d);
  const auto fx = static_cast<float>(view_->fx);
  const auto fy = static_cast<float>(view_->fy);
  DepthPlane& plane = planes_[surface];
  plane.du = n_C.x() / fx;
  plane.dv = n_C.y() / fy;
  plane.at_origin = n_C.z() - plane.du * static_cast<float>(view_->cx) - plane.dv * static_cast<float>(view_->cy);
  return true;
}

/// Cuts a triangle at the near plane (Sutherland and Hodgman): three or four corners are left.
void DepthRaster::draw_clipped(const std::array<const Corner*, 3>& corners, const DepthPlane& plane,
                               std::uint32_t triangle) {
  const auto near = static_cast<float>(parameters_.near_m);
  std::array<Eigen::Vector2f, 4> kept;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner& a = *corners[i];
    const Corner& b = *corners[(i + 1) % 3];
    if (a.w > 0.0F) kept[count++] = a.at;
    if ((a.w > 0.0F) == (b.w > 0.0F)) continue;
    const float t = (near - a.p.z()) / (b.p.z() - a.p.z());
    kept[count++] = (a.p + t * (b.p - a.p)).head<2>() / near;
  }
  for (std::size_t i = 2; i < count; ++i) buffer_.draw(kept[0], kept[i - 1], kept[i], plane, triangle);
}

void DepthRaster::look_at_edge(std::uint32_t name) {
  const world::Edge& edge = map_.edges[name];
  Line line;
  const auto near = static_cast<float>(parameters_.near_m);
  if (!line.set(corner(edge.vertices[0]), corner(edge.vertices[1]), *view_, near)) return;
  line.own = edge.surfaces;
  // An edge may lie behind by the tolerance: held a hair nearer, it need not be asked about at each sample.
  line.nearer = 1.0F / (1.0F - static_cast<float>(parameters_.tolerance));
  const float length = line.along.norm();
  if (length < 1e-3F) return;

  const auto cells = static_cast<float>(parameters_.sample_cells);
  const int samples = std::max(1, static_cast<int>(length / cells + 0.999F));
  const float spacing = 1.0F / static_cast<float>(samples);
  const float precision = std::min(static_cast<float>(parameters_.refine_cells) / length, 0.5F * spacing);

  const auto keep = [&](float begin, float end) {
    const VisiblePiece piece = line.piece(name, begin, end, *view_);
    const float long_px = (piece.p1 - piece.p0).norm();
    if (long_px < static_cast<float>(parameters_.piece_least_px) || found_.size() == found_.capacity()) return;
    if (piece.from < piece.to) found_.push_back(piece);
  };
  const float end_slack = 1.0F / length;  // a cell: at a corner, the cell below may belong to a third surface
  bool was = false;
  float begin = 0.0F;
  float before = 0.0F;
  for (int i = 0; i < samples; ++i) {
    const float s = (static_cast<float>(i) + 0.5F) * spacing;
    const bool is = visible(line, s);
    if (is && !was) {
      if (i > 0 || !visible(line, 0.0F)) {
        begin = last_visible(line, s, before, precision);
        if (begin <= end_slack) begin = 0.0F;
      } else {
        begin = 0.0F;
      }
    } else if (!is && was) {
      keep(begin, last_visible(line, before, s, precision));
    }
    was = is;
    before = s;
  }
  if (was) {
    float end = 1.0F;
    if (!visible(line, 1.0F)) {
      end = last_visible(line, before, 1.0F, precision);
      if (end >= 1.0F - end_slack) end = 1.0F;
    }
    keep(begin, end);
  }
}

bool DepthRaster::visible(const Line& line, float s) const {
  const float u = line.from.x() + s * line.along.x();
  const float v = line.from.y() + s * line.along.y();
  const float w = (line.w0 + s * line.dw) * line.nearer;
  const int x = std::clamp(static_cast<int>(u), 0, view_->width - 2);
  const int y = std::clamp(static_cast<int>(v), 0, view_->height - 2);
  const auto around = buffer_.names(x, y);
  const auto behind = [&](std::uint32_t triangle) {
    if (triangle == DepthBuffer::kNothing) return false;
    const std::uint32_t surface = surface_of_[triangle];
    return surface != line.own[0] && surface != line.own[1] && w < planes_[surface].at(u, v);
  };
  if (((around[0] ^ around[1]) | (around[0] ^ around[2]) | (around[0] ^ around[3])) == 0) return !behind(around[0]);
  int hiding = 0;
  for (const std::uint32_t triangle : around) {
    if (!behind(triangle)) continue;
    if (covers(triangle, u, v)) return false;
    ++hiding;
  }
  return hiding < 4;
}

/// Whether the triangle covers a place of the raster, exactly; one that is cut by the near plane is taken to.
bool DepthRaster::covers(std::uint32_t triangle, float u, float v) const {
  const world::Triangle& t = map_.triangles[triangle];
  const Corner& a = corners_[t[0]];
  const Corner& b = corners_[t[1]];
  const Corner& c = corners_[t[2]];
  if (a.w == 0.0F || b.w == 0.0F || c.w == 0.0F) return true;
  const auto side = [&](const Corner& from, const Corner& to) {
    return (to.at.x() - from.at.x()) * (v - from.at.y()) - (to.at.y() - from.at.y()) * (u - from.at.x());
  };
  const float ab = side(a, b);
  const float bc = side(b, c);
  if ((ab > 0.0F && bc < 0.0F) || (ab < 0.0F && bc > 0.0F)) return false;
  const float ca = side(c, a);
  return ab + bc >= 0.0F ? ca >= 0.0F && ab >= 0.0F && bc >= 0.0F : ca <= 0.0F;
}

float DepthRaster::last_visible(const Line& line, float seen, float hidden, float precision) const {
  while (std::abs(hidden - seen) > precision) {
    const float middle = 0.5F * (seen + hidden);
    (visible(line, middle) ? seen : hidden) = middle;
  }
  return 0.5F * (seen + hidden);
}

void DepthRaster::keep_longest(std::size_t capacity) {
  if (found_.size() <= capacity) return;
  lengths_.clear();
  for (const VisiblePiece& piece : found_) lengths_.push_back((piece.p1 - piece.p0).squaredNorm());
  const auto cut_at = lengths_.begin() + static_cast<std::ptrdiff_t>(found_.size() - capacity);
  std::nth_element(lengths_.begin(), cut_at, lengths_.end());
  const float least = *cut_at;
  std::erase_if(found_, [&](const VisiblePiece& piece) { return (piece.p1 - piece.p0).squaredNorm() < least; });
  if (found_.size() > capacity) found_.resize(capacity);  // equally long ones
}

}  // namespace cgsr::render
