#include "pipeline/render/lamp_view.h"

#include <algorithm>
#include <cmath>

namespace cgsr::render {
namespace {

RasterParameters raster_of(const ShadeParameters& parameters) {
  RasterParameters raster;
  raster.near_m = parameters.near_m;
  raster.surfaces_most = parameters.surfaces_most;
  raster.looked_at_most = std::max(raster.looked_at_most, 2 * parameters.surfaces_most);
  raster.triangles_most = 8 * parameters.surfaces_most;
  raster.surface_least_cells = 0.5;
  return raster;
}

/// Square, 90 degrees wide and high.
View face_of(int cells) {
  View view;
  view.width = cells;
  view.height = cells;
  view.left_px = -0.5;
  view.top_px = -0.5;
  view.right_px = cells - 0.5;
  view.bottom_px = cells - 0.5;
  view.fx = 0.5 * cells;
  view.fy = 0.5 * cells;
  view.cx = 0.5 * cells - 0.5;
  view.cy = 0.5 * cells - 0.5;
  return view;
}

/// Camera axes x, y, z of each face among those of W: index and sign. z looks out of the face, x x y = z.
struct Axes {
  int x, y, z;
  float sign_x, sign_y, sign_z;
};
constexpr std::array<Axes, 6> kFaces{{{1, 2, 0, 1, 1, 1},
                                      {1, 2, 0, -1, 1, -1},
                                      {2, 0, 1, 1, 1, 1},
                                      {2, 0, 1, -1, 1, -1},
                                      {0, 1, 2, 1, 1, 1},
                                      {0, 1, 2, -1, 1, -1}}};

}  // namespace

LampView::LampView(const world::Map& map, const ShadeParameters& parameters)
    : map_(map),
      margin_(static_cast<float>(parameters.margin)),
      view_(face_of(parameters.lamp_cells)),
      surfaces_(map, raster_of(parameters)),
      faces_(kFaces.size(), DepthBuffer(parameters.lamp_cells, parameters.lamp_cells)) {}

void LampView::place(const Eigen::Vector3f& p_WL) {
  p_WL_ = p_WL;
  for (std::size_t i = 0; i < kFaces.size(); ++i) {
    const Axes& axes = kFaces[i];
    geometry::Pose X_WF = geometry::Pose::Identity();
    X_WF.linear().setZero();
    X_WF.linear()(axes.x, 0) = axes.sign_x;
    X_WF.linear()(axes.y, 1) = axes.sign_y;
    X_WF.linear()(axes.z, 2) = axes.sign_z;
    X_WF.translation() = p_WL.cast<double>();
    surfaces_.draw(X_WF, view_, faces_[i]);
  }
}

LampView::Answer LampView::look_at(const Eigen::Vector3f& p_W, std::uint32_t own) const {
  const Eigen::Vector3f ray = p_W - p_WL_;
  const float ax = std::abs(ray.x());
  const float ay = std::abs(ray.y());
  const float az = std::abs(ray.z());
  const std::size_t axis = ax >= ay && ax >= az ? 0 : (ay >= az ? 1 : 2);
  const float along = ray[static_cast<Eigen::Index>(axis)];
  if (along == 0.0F) return {};
  const std::size_t face = 2 * axis + (along < 0.0F ? 1 : 0);
  const Axes& axes = kFaces[face];
  const float per_depth = static_cast<float>(view_.fx) / std::abs(along);
  const float u = axes.sign_x * ray[axes.x] * per_depth + static_cast<float>(view_.cx);
  const float v = axes.sign_y * ray[axes.y] * per_depth + static_cast<float>(view_.cy);
  const int x = std::clamp(static_cast<int>(u), 0, view_.width - 2);
  const int y = std::clamp(static_cast<int>(v), 0, view_.height - 2);
  const auto around = faces_[face].names(x, y);
  const auto hides = [&](std::uint32_t triangle) {
    return triangle != DepthBuffer::kNothing && surfaces_.surface_of(triangle) != own && stands_before(triangle, ray);
  };
  if (((around[0] ^ around[1]) | (around[0] ^ around[2]) | (around[0] ^ around[3])) == 0) {
    return {hides(around[0]), around[0]};
  }
  const bool hidden = hides(around[0]) || (around[1] != around[0] && hides(around[1])) ||
                      (around[2] != around[0] && hides(around[2])) || (around[3] != around[1] && hides(around[3]));
  return {hidden, kMixed};
}

/// Whether the way from the lamp along `ray` meets the triangle before it ends (Moeller and Trumbore), the lamp at the origin.
bool LampView::stands_before(std::uint32_t triangle, const Eigen::Vector3f& ray) const {
  const world::Triangle& t = map_.triangles[triangle];
  const Eigen::Vector3f a = map_.vertices[t[0]] - p_WL_;
  const Eigen::Vector3f e1 = map_.vertices[t[1]] - map_.vertices[t[0]];
  const Eigen::Vector3f e2 = map_.vertices[t[2]] - map_.vertices[t[0]];
  const Eigen::Vector3f n = e1.cross(e2);
  const float det = -ray.dot(n);
  if (det == 0.0F) return false;
  const float at = -a.dot(n) / det;
  if (!(at > 0.0F && at < 1.0F - margin_)) return false;
  const Eigen::Vector3f q = a.cross(ray);  // barycentric coordinates, times det
  const float sign = det > 0.0F ? 1.0F : -1.0F;
  const float b1 = sign * -q.dot(e2);
  const float b2 = sign * q.dot(e1);
  return b1 >= 0.0F && b2 >= 0.0F && b1 + b2 <= std::abs(det);
}

}  // namespace cgsr::render
