#include "hal/sim/scene/shapes.h"

#include <cmath>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

// The face of a box whose outward normal is `n`, with `right` x `up` = `n`.
void add_face(Mesh& mesh, const Vector3d& centre, const Vector3d& right, const Vector3d& up) {
  std::vector<Vector3f> corners;
  std::vector<Vector2f> uv;
  const double w = right.norm();
  const double h = up.norm();
  for (const auto& [s, t] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
    corners.emplace_back((centre + s * right + t * up).cast<float>());
    uv.emplace_back(static_cast<float>(s * w), static_cast<float>(t * h));
  }
  mesh.add_polygon(corners, uv);
}

constexpr int kAround = 192;  // sagitta of a 2 cm circle: 3 um; of a 10 cm one: 13 um

void add_cap(Mesh& mesh, double radius_m, double z_m, bool up) {
  std::vector<Vector3f> corners;
  std::vector<Vector2f> uv;
  for (int i = 0; i < kAround; ++i) {
    const double a = 2.0 * kPi * (up ? i : -i) / kAround;
    const double x = radius_m * cosine(a);
    const double y = radius_m * sine(a);
    corners.emplace_back(Vector3d(x, y, z_m).cast<float>());
    uv.emplace_back(static_cast<float>(x), static_cast<float>(y));
  }
  mesh.add_polygon(corners, uv);
}

}  // namespace

void connect_grid(Mesh& mesh, int rows, int columns) {
  const auto corner = [columns](int row, int column) {
    return static_cast<std::uint32_t>(row * (columns + 1) + column);
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const std::uint32_t a = corner(row, column);
      const std::uint32_t b = corner(row, column + 1);
      const std::uint32_t c = corner(row + 1, column + 1);
      const std::uint32_t d = corner(row + 1, column);
      const auto polygon = static_cast<std::uint32_t>(mesh.polygons.size());
      mesh.triangles.push_back({{a, b, c}, polygon});
      mesh.triangles.push_back({{a, c, d}, polygon});
      mesh.polygons.push_back({a, b, c, d});
    }
  }
  mesh.smooth = true;
}

Mesh make_rectangle(double width_m, double depth_m) {
  Mesh mesh;
  add_face(mesh, Vector3d::Zero(), Vector3d::UnitX() * width_m / 2, Vector3d::UnitY() * depth_m / 2);
  return mesh;
}

Mesh make_box(const Vector3d& size_m) {
  Mesh mesh;
  const Vector3d x = Vector3d::UnitX() * size_m.x() / 2;
  const Vector3d y = Vector3d::UnitY() * size_m.y() / 2;
  const Vector3d z = Vector3d::UnitZ() * size_m.z() / 2;
  add_face(mesh, z, x, y);
  add_face(mesh, -z, x, -y);
  add_face(mesh, x, y, z);
  add_face(mesh, -x, -y, z);
  add_face(mesh, y, -x, z);
  add_face(mesh, -y, x, z);
  return mesh;
}

Mesh make_cone(double base_radius_m, double height_m, double top_radius_m) {
  Mesh mesh;
  const double slant = std::sqrt(height_m * height_m + (base_radius_m - top_radius_m) * (base_radius_m - top_radius_m));
  const double n_out = height_m / slant;
  const double n_up = (base_radius_m - top_radius_m) / slant;
  for (int row = 0; row <= 1; ++row) {
    const double radius = row == 0 ? base_radius_m : top_radius_m;
    for (int i = 0; i <= kAround; ++i) {
      const double a = 2.0 * kPi * (i % kAround) / kAround;
      mesh.position_m.emplace_back(Vector3d(radius * cosine(a), radius * sine(a), row * height_m).cast<float>());
      mesh.normal.emplace_back(Vector3d(n_out * cosine(a), n_out * sine(a), n_up).cast<float>());
      mesh.uv.emplace_back(static_cast<float>(base_radius_m * 2.0 * kPi * i / kAround),
                           static_cast<float>(row * slant));
    }
  }
  connect_grid(mesh, 1, kAround);
  add_cap(mesh, base_radius_m, 0.0, false);
  if (top_radius_m > 0.0) add_cap(mesh, top_radius_m, height_m, true);
  return mesh;
}

Mesh make_cylinder(double radius_m, double height_m) {
  return make_cone(radius_m, height_m, radius_m);
}

Mesh make_ellipsoid(const Vector3d& semi_axes_m, int around, int along) {
  Mesh mesh;
  for (int row = 0; row <= along; ++row) {
    const double latitude = kPi * (static_cast<double>(row) / along - 0.5);
    const double ring = row == 0 || row == along ? 0.0 : cosine(latitude);
    for (int i = 0; i <= around; ++i) {
      const double a = 2.0 * kPi * (i % around) / around;
      const Vector3d on_unit(ring * cosine(a), ring * sine(a), sine(latitude));
      mesh.position_m.emplace_back(on_unit.cwiseProduct(semi_axes_m).cast<float>());
      mesh.normal.emplace_back(on_unit.cwiseQuotient(semi_axes_m).normalized().cast<float>());
      mesh.uv.emplace_back(static_cast<float>(semi_axes_m.x() * 2.0 * kPi * i / around),
                           static_cast<float>(semi_axes_m.z() * latitude));
    }
  }
  connect_grid(mesh, along, around);
  return mesh;
}

Mesh make_sphere(double radius_m) {
  return make_ellipsoid(Vector3d::Constant(radius_m), 128, 64);
}

Mesh make_disc(double radius_m) {
  Mesh mesh;
  add_cap(mesh, radius_m, 0.0, true);
  return mesh;
}

Mesh make_lofted(const std::vector<Station>& stations, int around) {
  Mesh mesh;
  std::vector<Station> closed = stations;
  const auto end = [](Station station) {
    station.half_width_m = station.half_depth_m = 0.0;
    return station;
  };
  closed.insert(closed.begin(), end(stations.front()));
  closed.push_back(end(stations.back()));
  for (const Station& s : closed) {
    for (int i = 0; i <= around; ++i) {
      const double a = 2.0 * kPi * (i % around) / around;
      mesh.position_m.emplace_back(
          Vector3d(s.centre_x_m + s.half_depth_m * cosine(a), s.half_width_m * sine(a), s.z_m).cast<float>());
      mesh.normal.emplace_back(Vector3f::UnitZ());
      const double girth = kPi * (s.half_width_m + s.half_depth_m);
      mesh.uv.emplace_back(static_cast<float>(girth * i / around), static_cast<float>(s.z_m));
    }
  }
  connect_grid(mesh, static_cast<int>(closed.size()) - 1, around);
  mesh.smooth_normals();
  // The seam is two columns of corners in one place: they share their normal.
  for (std::size_t row = 0; row < closed.size(); ++row) {
    const std::size_t first = row * static_cast<std::size_t>(around + 1);
    const std::size_t last = first + static_cast<std::size_t>(around);
    const Vector3f sum = mesh.normal[first] + mesh.normal[last];
    if (sum.norm() > 0.0F) mesh.normal[first] = mesh.normal[last] = sum.normalized();
  }
  return mesh;
}

}  // namespace cgsr::sim
