#include "hal/sim/render/surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

namespace cgsr::sim {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kLift_m = 1e-4F;  // shadow rays start this far off the surface

// Gradients of u and v over the triangle's plane: the 2x3 pseudo-inverse of its edges applied to the differences of uv.
std::pair<Vector3f, Vector3f> uv_gradients(const Mesh& mesh, const Mesh::Triangle& t) {
  const Vector3f e1 = mesh.position_m[t.corner[1]] - mesh.position_m[t.corner[0]];
  const Vector3f e2 = mesh.position_m[t.corner[2]] - mesh.position_m[t.corner[0]];
  const Vector2f d1 = mesh.uv[t.corner[1]] - mesh.uv[t.corner[0]];
  const Vector2f d2 = mesh.uv[t.corner[2]] - mesh.uv[t.corner[0]];
  const float a = e1.dot(e1);
  const float b = e1.dot(e2);
  const float c = e2.dot(e2);
  const float determinant = a * c - b * b;
  if (determinant <= 0.0F) return {Vector3f::Zero(), Vector3f::Zero()};
  const Vector3f w1 = (c * e1 - b * e2) / determinant;  // dual basis: w1.e1 = 1, w1.e2 = 0
  const Vector3f w2 = (a * e2 - b * e1) / determinant;
  return {d1.x() * w1 + d2.x() * w2, d1.y() * w1 + d2.y() * w2};
}

// Shadow rays of a curved part start on the curved surface that its triangles stand for, not on the chord, so that facets which
// look away from the lamp do not shade their neighbours: the mean of the projections on the corners' tangent planes.
Vector3f off_the_chord(const Mesh& mesh, const Mesh::Triangle& t, const std::array<float, 3>& weight,
                       const Vector3f& p) {
  Vector3f sum = Vector3f::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3f& n = mesh.normal[t.corner[i]];
    const float below = std::min(0.0F, (p - mesh.position_m[t.corner[i]]).dot(n));
    sum += weight[i] * (p - below * n);
  }
  return sum;
}

}  // namespace

Surfaces::Surfaces(const Scene& scene) : scene_(&scene) {
  for (const Part& part : scene.parts) {
    const Material& material = scene.materials[static_cast<std::size_t>(part.material)];
    PartData data;
    data.moves = part.figure >= 0;
    data.patterned = material.texture >= 0 || material.pattern != PatternKind::kPlain;
    data.triangles.reserve(part.mesh.triangles.size());
    for (const Mesh::Triangle& t : part.mesh.triangles) {
      const Vector3f& a = part.mesh.position_m[t.corner[0]];
      const Vector3f n = (part.mesh.position_m[t.corner[1]] - a).cross(part.mesh.position_m[t.corner[2]] - a);
      const auto [u, v] = uv_gradients(part.mesh, t);
      data.triangles.push_back({n.normalized(), u, v, -1});
    }
    parts_.push_back(std::move(data));
  }
}

// The footprint is an ellipse: one pixel wide across the line of sight, longer by 1 / cos along it.
void Surfaces::place(const Mesh& mesh, const Mesh::Triangle& triangle, const TriangleFrame& frame,
                     const std::array<float, 3>& weight, const Tracer::Placement& X, const Ray& ray, Surfel& s) const {
  s.at.uv = weight[0] * mesh.uv[triangle.corner[0]] + weight[1] * mesh.uv[triangle.corner[1]] +
            weight[2] * mesh.uv[triangle.corner[2]];
  const Vector3f ng = X.R * frame.n;
  const float length = ray.direction.norm();
  const float across = s.depth_m * ray.width;
  const float cosine = std::max(0.02F, std::abs(ng.dot(ray.direction)) / length);
  const Vector3f sideways = ng.cross(ray.direction);
  const float sideways_length = sideways.norm();
  const Vector3f a1 = sideways_length > 1e-6F * length ? Vector3f(sideways / sideways_length) : ng.unitOrthogonal();
  const Vector3f a2 = ng.cross(a1) / cosine;
  const Vector3f gu = X.R * frame.u_per_m;
  const Vector3f gv = X.R * frame.v_per_m;
  s.at.width =
      across * Vector2f(std::abs(a1.dot(gu)) + std::abs(a2.dot(gu)), std::abs(a1.dot(gv)) + std::abs(a2.dot(gv)));
}

Surfel Surfaces::at(const Tracer& tracer, const Met& met, const Ray& ray, float depth_m) const {
  const Mesh& mesh = scene_->parts[static_cast<std::size_t>(met.part)].mesh;
  const PartData& data = parts_[static_cast<std::size_t>(met.part)];
  const Mesh::Triangle& triangle = mesh.triangles[met.triangle];
  const TriangleFrame& frame = data.triangles[met.triangle];
  const Tracer::Placement& X = tracer.placement(met.part);
  const std::array<float, 3> weight{1.0F - met.u - met.v, met.u, met.v};

  Surfel s;
  s.part = met.part;
  s.polygon = triangle.polygon;
  s.depth_m = depth_m;
  s.p_W = ray.origin + depth_m * ray.direction;
  const Vector3f ng = data.moves ? Vector3f(X.R * frame.n) : frame.n;
  const float side = ng.dot(ray.direction) > 0.0F ? -1.0F : 1.0F;
  s.n_W = side * ng;
  s.p_WShadow = s.p_W;
  if (mesh.smooth) {
    const Vector3f n = weight[0] * mesh.normal[triangle.corner[0]] + weight[1] * mesh.normal[triangle.corner[1]] +
                       weight[2] * mesh.normal[triangle.corner[2]];
    s.n_W = side * (X.R * n).normalized();
    if (side > 0.0F) {
      const Vector3f p_local = X.R.transpose() * (s.p_W - X.p);
      s.p_WShadow = X.R * off_the_chord(mesh, triangle, weight, p_local) + X.p;
    }
  }
  s.p_WShadow += kLift_m * side * ng;
  if (data.patterned) place(mesh, triangle, frame, weight, X, ray, s);

  if (frame.map >= 0) {
    s.open = open_at(maps_[static_cast<std::size_t>(frame.map)], s.p_W);
  } else if (!data.open_at_corner.empty()) {
    s.open = weight[0] * data.open_at_corner[triangle.corner[0]] + weight[1] * data.open_at_corner[triangle.corner[1]] +
             weight[2] * data.open_at_corner[triangle.corner[2]];
  }
  return s;
}

float Surfaces::open_at(const OpenMap& map, const Vector3f& p_W) const {
  const Vector3f from = p_W - map.origin;
  const float x = std::clamp(from.dot(map.along_x) - 0.5F, 0.0F, static_cast<float>(map.width - 1));
  const float y = std::clamp(from.dot(map.along_y) - 0.5F, 0.0F, static_cast<float>(map.height - 1));
  const int x0 = std::min(static_cast<int>(x), map.width - 2);
  const int y0 = std::min(static_cast<int>(y), map.height - 2);
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const float* row = &open_[map.first + static_cast<std::size_t>(y0 * map.width + x0)];
  const float* next = row + map.width;
  const float low = row[0] + fx * (row[1] - row[0]);
  const float high = next[0] + fx * (next[1] - next[0]);
  return low + fy * (high - low);
}

}  // namespace cgsr::sim
