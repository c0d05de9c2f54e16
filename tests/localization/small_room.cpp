#include "tests/localization/small_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "tests/localization/random_numbers.h"

namespace cgsr::localization::testing {
namespace {

using Eigen::Vector3f;

struct Face {
  std::array<std::uint32_t, 4> corners;
  std::uint32_t surface;
};

}  // namespace

std::uint32_t MapBuilder::grey(float value) {
  map.materials.push_back({.name = "grey", .color = Vector3f::Constant(value)});
  return static_cast<std::uint32_t>(map.materials.size() - 1);
}

namespace {

std::uint32_t add_face(world::Map& map, const std::array<std::uint32_t, 4>& corners, std::uint32_t material) {
  const Vector3f& a = map.vertices[corners[0]];
  world::Surface surface;
  surface.first_triangle = static_cast<std::uint32_t>(map.triangles.size());
  surface.triangle_count = 2;
  surface.material = material;
  surface.normal = (map.vertices[corners[1]] - a).cross(map.vertices[corners[3]] - a).normalized();
  surface.offset_m = surface.normal.dot(a);
  map.triangles.push_back({corners[0], corners[1], corners[2]});
  map.triangles.push_back({corners[0], corners[2], corners[3]});
  map.surfaces.push_back(surface);
  return static_cast<std::uint32_t>(map.surfaces.size() - 1);
}

float contrast_between(const world::Map& map, const std::array<std::uint32_t, 2>& sides) {
  if (sides[0] == world::kNone || sides[1] == world::kNone) return 0.25F;
  const auto luma = [&](std::uint32_t s) { return map.materials[map.surfaces[s].material].color.x(); };
  const float shading = std::abs(map.surfaces[sides[0]].normal.dot(map.surfaces[sides[1]].normal)) < 0.9F ? 0.1F : 0.0F;
  return std::abs(luma(sides[0]) - luma(sides[1])) + shading;
}

void add_outline(world::Map& map, const std::vector<Face>& faces, std::uint32_t on) {
  const std::size_t first = map.edges.size();
  for (const Face& face : faces) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t a = face.corners[i];
      const std::uint32_t b = face.corners[(i + 1) % 4];
      const auto twin = std::find_if(map.edges.begin() + static_cast<std::ptrdiff_t>(first), map.edges.end(),
                                     [&](const world::Edge& e) { return e.vertices[0] == b && e.vertices[1] == a; });
      if (twin != map.edges.end()) {
        twin->surfaces[1] = twin->sides[1] = face.surface;
        twin->kind = world::EdgeKind::kCrease;
        continue;
      }
      map.edges.push_back({.vertices = {a, b},
                           .surfaces = {face.surface, world::kNone},
                           .sides = {face.surface, on},
                           .kind = world::EdgeKind::kBorder});
    }
  }
  for (std::size_t i = first; i < map.edges.size(); ++i)
    map.edges[i].contrast = contrast_between(map, map.edges[i].sides);
}

}  // namespace

std::uint32_t MapBuilder::rectangle(const Vector3f& corner, const Vector3f& u, const Vector3f& v,
                                    std::uint32_t material, std::uint32_t on) {
  const auto n = static_cast<std::uint32_t>(map.vertices.size());
  map.vertices.insert(map.vertices.end(), {corner, corner + u, corner + u + v, corner + v});
  const std::array<std::uint32_t, 4> corners = {n, n + 1, n + 2, n + 3};
  const std::uint32_t surface = add_face(map, corners, material);
  add_outline(map, {{corners, surface}}, on);
  return surface;
}

void MapBuilder::box(const Vector3f& corner, const Vector3f& size, std::uint32_t material, std::uint32_t on) {
  const auto n = static_cast<std::uint32_t>(map.vertices.size());
  for (const float z : {0.0F, 1.0F})
    for (const auto& [x, y] : {std::pair{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}})
      map.vertices.emplace_back(corner + size.cwiseProduct(Vector3f(x, y, z)));
  std::vector<Face> faces;
  for (const std::array<std::uint32_t, 4>& c :
       {std::array<std::uint32_t, 4>{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}}) {
    Face face;
    for (std::size_t i = 0; i < 4; ++i) face.corners[i] = n + c[i];
    face.surface = add_face(map, face.corners, material);
    faces.push_back(face);
  }
  add_outline(map, faces, on);
}

world::Map small_room() {
  MapBuilder b;
  const std::uint32_t floor_grey = b.grey(0.35F);
  const std::uint32_t wall_grey = b.grey(0.7F);
  const std::uint32_t white = b.grey(0.92F);
  const std::uint32_t dark = b.grey(0.15F);
  const std::uint32_t middle = b.grey(0.5F);
  const std::uint32_t floor = b.rectangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, floor_grey);
  const std::uint32_t east = b.rectangle({4, 0, 0}, {0, 0, 2.5F}, {0, 4, 0}, wall_grey);
  const std::uint32_t north = b.rectangle({0, 4, 0}, {4, 0, 0}, {0, 0, 2.5F}, wall_grey);
  b.rectangle({0, 0, 0}, {0, 4, 0}, {0, 0, 2.5F}, wall_grey);
  b.rectangle({0, 0, 0}, {0, 0, 2.5F}, {4, 0, 0}, wall_grey);
  // What the walls share with each other and the floor once would do; the pairs lie upon each other and match as one.
  b.rectangle({1.0F, 0.9F, 0.002F}, {2.2F, 0, 0}, {0, 0.06F, 0}, white, floor);
  b.rectangle({2.9F, 1.2F, 0.002F}, {0.06F, 0, 0}, {0, 1.9F, 0}, white, floor);
  b.rectangle({1.5F, 2.7F, 0.002F}, {0.9F, 0, 0}, {0, 0.06F, 0}, white, floor);
  b.rectangle({3.998F, 1.1F, 0.9F}, {0, 0, 0.7F}, {0, 0.5F, 0}, dark, east);
  b.rectangle({3.998F, 2.4F, 0.0F}, {0, 0, 1.9F}, {0, 0.8F, 0}, middle, east);
  b.rectangle({1.2F, 3.998F, 1.0F}, {0.8F, 0, 0}, {0, 0, 0.6F}, dark, north);
  b.rectangle({2.6F, 3.998F, 0.6F}, {0.5F, 0, 0}, {0, 0, 0.9F}, white, north);
  b.box({3.1F, 3.2F, 0}, {0.5F, 0.45F, 0.4F}, dark, floor);
  b.box({3.4F, 0.3F, 0}, {0.4F, 0.5F, 0.7F}, white, floor);
  return b.map;
}

geometry::Pose leaning(double pitch_rad, double axle_height_m) {
  const Eigen::Vector3d axle(0.0, 0.0, axle_height_m);
  geometry::Pose tilt = geometry::Pose::Identity();
  tilt.linear() = Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  tilt.translation() = axle - tilt.linear() * axle;
  return tilt;
}

geometry::Pose in_small_room(double x_m, double y_m, double heading_rad) {
  geometry::Pose X_RC = geometry::Pose::Identity();
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // forward is z, left is -x, up is -y
  const double down = 0.12;
  X_RC.linear() = Eigen::AngleAxisd(down, Eigen::Vector3d::UnitY()).toRotationMatrix() * R;
  X_RC.translation() = Eigen::Vector3d(0.0, 0.0, 0.6);
  return geometry::pose_on_floor(x_m, y_m, heading_rad) * X_RC;
}

namespace {

/// A surface of the map as a ray meets it, and how bright it is.
struct Plane {
  Eigen::Vector3d normal;
  double offset;
  Eigen::AlignedBox3d bounds;
  std::vector<std::array<Eigen::Vector3d, 3>> triangles;
  double value;

  [[nodiscard]] bool covers(const Eigen::Vector3d& p) const {
    if (!bounds.contains(p)) return false;
    return std::ranges::any_of(triangles, [&](const auto& corners) {
      bool within = true;
      for (std::size_t k = 0; k < 3 && within; ++k) {
        const Eigen::Vector3d& a = corners[k];
        within = (corners[(k + 1) % 3] - a).cross(p - a).dot(normal) >= 0.0;
      }
      return within;
    });
  }
};

std::vector<Plane> planes_of(const world::Map& map) {
  const Eigen::Vector3d sun = Eigen::Vector3d(0.4, -0.6, 0.8).normalized();
  std::vector<Plane> planes;
  for (const world::Surface& surface : map.surfaces) {
    Plane& plane = planes.emplace_back();
    plane.normal = surface.normal.cast<double>();
    plane.offset = static_cast<double>(surface.offset_m);
    plane.value = static_cast<double>(map.materials[surface.material].color.x()) *
                  (0.75 + 0.25 * std::abs(plane.normal.dot(sun)));
    for (std::uint32_t t = 0; t < surface.triangle_count; ++t) {
      auto& corners = plane.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = map.vertices[map.triangles[surface.first_triangle + t][k]].cast<double>();
        plane.bounds.extend(corners[k]);
      }
    }
    plane.bounds.min().array() -= 1e-6;
    plane.bounds.max().array() += 1e-6;
  }
  return planes;
}

/// The brightness of the first plane that a ray meets; 0: none.
double seen_along(const std::vector<Plane>& planes, const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) {
  double nearest = std::numeric_limits<double>::max();
  double value = 0.0;
  for (const Plane& plane : planes) {
    const double slope = plane.normal.dot(ray);
    if (std::abs(slope) < 1e-9) continue;
    const double depth = (plane.offset - plane.normal.dot(eye)) / slope;
    if (depth < 0.01 || depth >= nearest || !plane.covers(eye + depth * ray)) continue;
    nearest = depth;
    value = plane.value;
  }
  return value;
}

}  // namespace

Picture::Picture(const world::Map& map, const geometry::Pose& X_WC, const geometry::Camera& camera, double noise,
                 std::uint32_t seed)
    : pixels(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px)),
      width_(camera.width_px),
      height_(camera.height_px) {
  RandomNumbers random(seed);
  const std::vector<Plane> planes = planes_of(map);
  const auto seen = [&](double u, double v) {
    const Eigen::Vector2d ideal = camera.ideal_of({u, v});
    return seen_along(planes, X_WC.translation(), X_WC.linear() * Eigen::Vector3d(ideal.x(), ideal.y(), 1.0));
  };
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      double sum = 0.0;
      for (const double dy : {-0.25, 0.25})
        for (const double dx : {-0.25, 0.25}) sum += seen(x + dx, y + dy);
      const double value = 20.0 + 200.0 * sum / 4.0 + noise * random.normal();
      pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] =
          static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
    }
  }
}

ImageView Picture::view() const {
  return {.data = pixels.data(),
          .width_px = width_,
          .height_px = height_,
          .stride_bytes = width_,
          .format = PixelFormat::kGrey8};
}

}  // namespace cgsr::localization::testing
