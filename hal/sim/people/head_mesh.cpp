#include <algorithm>
#include <cmath>

#include "hal/sim/people/head.h"
#include "hal/sim/scene/portable_math.h"
#include "hal/sim/scene/scene.h"
#include "hal/sim/scene/shapes.h"

namespace cgsr::sim {
namespace {

constexpr int kAround = 128;
constexpr int kAlong = 96;

double bell(double y, double z, double y0, double z0, double half_width, double half_height) {
  const double a = (y - y0) / half_width;
  const double b = (z - z0) / half_height;
  const double square = a * a + b * b;
  return square > 12.0 ? 0.0 : exponential(-square);
}

// How far the face stands out before the ellipsoid [m].
double relief(const Identity& id, double y, double z) {
  const double side = std::abs(y);
  const double eye = static_cast<double>(id.eye_apart_m);
  const double nose_end = -static_cast<double>(id.nose_length_m);
  const double wide = static_cast<double>(id.nose_width);
  double out = 0.0;
  out -= 0.011 * bell(side, z, eye, 0.001, 0.017, 0.013);
  out += 0.0045 * bell(side, z, eye, 0.0, 0.011, 0.008);
  out += 0.004 * bell(side, z, 0.030, static_cast<double>(id.brow_up_m) - 0.002, 0.022, 0.007);
  // The nose: a ridge that grows from between the eyes to its tip and ends abruptly.
  const double along = std::clamp((0.012 - z) / (0.012 - nose_end), 0.0, 1.0);
  const double below = z < nose_end ? exponential(-(z - nose_end) * (z - nose_end) / (0.005 * 0.005)) : 1.0;
  const double half = (0.007 + 0.006 * along) * wide;
  out += 0.022 * along * below * exponential(-std::min(12.0, y * y / (half * half)));
  out += 0.008 * bell(side, z, 0.013 * wide, nose_end + 0.005, 0.007, 0.008);
  const double mouth = -static_cast<double>(id.mouth_down_m);
  out += 0.006 * bell(y, z, 0.0, mouth, 1.1 * static_cast<double>(id.mouth_width_m), 0.011);
  out -= 0.002 * bell(y, z, 0.0, mouth, static_cast<double>(id.mouth_width_m), 0.002);
  out += 0.009 * bell(y, z, 0.0, -0.098, 0.022, 0.015);
  return out;
}

Eigen::Vector3d shaped(const Identity& id, double s, double t) {
  const OnHead at = on_head(s, t);
  const double latitude = t * kPi / 2;
  Eigen::Vector3d p(kHeadDepth_m * cosine(latitude) * at.front, at.y_m, at.z_m);
  if (p.z() < 0.0) {
    const double down = -p.z() / kHeadHeight_m;
    p.y() *= 1.0 - static_cast<double>(id.jaw) * down * std::sqrt(down);
  }
  if (at.front > 0.0) p.x() += relief(id, p.y(), p.z()) * std::min(1.0, 2.5 * at.front);
  // Hair stands off the skull, above the hairline and behind the temples.
  const double temple = 0.025 + 0.5 * std::max(0.0, 0.35 - at.front) * 0.2;
  const double line = at.front > 0.25 ? static_cast<double>(id.hairline_m)
                                      : static_cast<double>(id.hair_back_m) + temple * std::max(0.0, at.front);
  const double hair = std::clamp((at.z_m - line) / 0.008, 0.0, 1.0);
  p *= 1.0 + 0.075 * hair;
  return {p.x(), p.y() * static_cast<double>(id.width), p.z() * static_cast<double>(id.height)};
}

// Ears take the colour of the cheek next to them.
void add_ears(const Identity& id, Mesh& mesh) {
  for (const double side : {1.0, -1.0}) {
    Mesh ear = make_ellipsoid({0.020, 0.007, 0.032}, 16, 12);
    ear.transform(pose_at({-0.008, side * 0.073 * static_cast<double>(id.width), -0.008}));
    for (Eigen::Vector2f& uv : ear.uv) uv = Eigen::Vector2f(side > 0 ? 0.735F : 0.265F, 0.60F);
    mesh.append(ear);
  }
}

}  // namespace

OnHead on_head(double s, double t) {
  const double longitude = kPi * s * (0.45 + 0.55 * s * s);
  const double latitude = t * kPi / 2;
  return {kHeadWidth_m * cosine(latitude) * sine(longitude), kHeadHeight_m * sine(latitude), cosine(longitude)};
}

Mesh head_mesh(const Identity& id) {
  Mesh mesh;
  for (int row = 0; row <= kAlong; ++row) {
    const double t = 2.0 * row / kAlong - 1.0;
    for (int column = 0; column <= kAround; ++column) {
      const double s = 2.0 * column / kAround - 1.0;
      mesh.position_m.emplace_back(shaped(id, s, t).cast<float>());
      mesh.normal.emplace_back(Eigen::Vector3f::UnitZ());
      mesh.uv.emplace_back(static_cast<float>((s + 1) / 2), static_cast<float>((1 - t) / 2));
    }
  }
  connect_grid(mesh, kAlong, kAround);
  mesh.smooth_normals();
  add_ears(id, mesh);
  return mesh;
}

}  // namespace cgsr::sim
