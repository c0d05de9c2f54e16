#include "hal/sim/render/open_baker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Geometry>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector3f;

constexpr float kGrid_m = 0.12F;
constexpr int kMostTexels = 128;
constexpr int kDirections = 64;
constexpr float kPassedOn = 0.3F;  // what even a blocked direction gives: walls are bright themselves

// A fixed cosine-weighted set on the hemisphere about +z: the golden-angle spiral on the unit disc, lifted.
std::array<Vector3f, kDirections> hemisphere() {
  std::array<Vector3f, kDirections> directions;
  for (int i = 0; i < kDirections; ++i) {
    const double r2 = (i + 0.5) / kDirections;
    const double angle = 2.399963229728653 * i;
    directions[static_cast<std::size_t>(i)] =
        Eigen::Vector3d(std::sqrt(r2) * cosine(angle), std::sqrt(r2) * sine(angle), std::sqrt(1.0 - r2)).cast<float>();
  }
  return directions;
}

}  // namespace

OpenBaker::OpenBaker(const Scene& scene, Tracer& tracer, Surfaces& surfaces)
    : scene_(scene), tracer_(tracer), surfaces_(surfaces) {}

void OpenBaker::lay_out() {
  for (std::size_t i = 0; i < scene_.parts.size(); ++i) {
    const Part& part = scene_.parts[i];
    if (part.figure >= 0) continue;
    const Mesh& mesh = part.mesh;
    if (mesh.smooth) {
      surfaces_.parts_[i].open_at_corner.assign(mesh.position_m.size(), 1.0F);
      continue;
    }
    std::vector<std::int32_t> map_of(mesh.polygons.size(), -1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      std::int32_t& map = map_of[mesh.triangles[t].polygon];
      if (map < 0) {
        const std::vector<std::uint32_t>& outline = mesh.polygons[mesh.triangles[t].polygon];
        const Vector3f n = surfaces_.parts_[i].triangles[t].n;
        const Vector3f x = (mesh.position_m[outline[1]] - mesh.position_m[outline[0]]).normalized();
        const Vector3f y = n.cross(x);
        Eigen::AlignedBox2f box;
        for (const std::uint32_t corner : outline) {
          box.extend(Eigen::Vector2f(mesh.position_m[corner].dot(x), mesh.position_m[corner].dot(y)));
        }
        Surfaces::OpenMap open;
        open.width = std::clamp(static_cast<int>(std::lround(box.sizes().x() / kGrid_m)), 2, kMostTexels);
        open.height = std::clamp(static_cast<int>(std::lround(box.sizes().y() / kGrid_m)), 2, kMostTexels);
        open.along_x = x * (static_cast<float>(open.width) / std::max(box.sizes().x(), 1e-6F));
        open.along_y = y * (static_cast<float>(open.height) / std::max(box.sizes().y(), 1e-6F));
        open.n = n;
        open.origin = x * box.min().x() + y * box.min().y() + n * n.dot(mesh.position_m[outline[0]]);
        open.first = surfaces_.open_.size();
        surfaces_.open_.resize(open.first + static_cast<std::size_t>(open.width * open.height), 1.0F);
        map = static_cast<std::int32_t>(surfaces_.maps_.size());
        surfaces_.maps_.push_back(open);
      }
      surfaces_.parts_[i].triangles[t].map = map;
    }
  }
}

float OpenBaker::open_from(const Vector3f& p_W, const Vector3f& n_W, float reach_m) const {
  static const auto kDirectionSet = hemisphere();
  const Vector3f x = n_W.unitOrthogonal();
  const Vector3f y = n_W.cross(x);
  const Vector3f origin = p_W + 2e-3F * n_W;
  alignas(32) int valid[kPacket];
  std::fill(std::begin(valid), std::end(valid), -1);
  float sum = 0.0F;
  for (int first = 0; first < kDirections; first += kPacket) {
    alignas(32) RTCRayHit8 rays{};
    for (int lane = 0; lane < kPacket; ++lane) {
      const Vector3f& local = kDirectionSet[static_cast<std::size_t>(first + lane)];
      const Vector3f d = local.x() * x + local.y() * y + local.z() * n_W;
      rays.ray.org_x[lane] = origin.x();
      rays.ray.org_y[lane] = origin.y();
      rays.ray.org_z[lane] = origin.z();
      rays.ray.dir_x[lane] = d.x();
      rays.ray.dir_y[lane] = d.y();
      rays.ray.dir_z[lane] = d.z();
      rays.ray.tfar[lane] = reach_m;
      rays.ray.mask[lane] = kShadowRays;
      rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    tracer_.nearest(valid, rays, false);
    for (int lane = 0; lane < kPacket; ++lane) sum += rays.ray.tfar[lane] / reach_m;
  }
  return kPassedOn + (1.0F - kPassedOn) * sum / kDirections;
}

void OpenBaker::bake(double reach_m, Workers& workers) {
  SceneState nothing_moves = state_at(scene_, 0.0);
  for (PresenceKey& presence : nothing_moves.presence) presence.present = false;
  tracer_.update(nothing_moves);
  lay_out();
  const auto reach = static_cast<float>(reach_m);

  workers.run(static_cast<int>(surfaces_.maps_.size()), [&](int index) {
    const Surfaces::OpenMap& map = surfaces_.maps_[static_cast<std::size_t>(index)];
    for (int y = 0; y < map.height; ++y) {
      for (int x = 0; x < map.width; ++x) {
        const Vector3f p = map.origin + (static_cast<float>(x) + 0.5F) * map.along_x / map.along_x.squaredNorm() +
                           (static_cast<float>(y) + 0.5F) * map.along_y / map.along_y.squaredNorm();
        surfaces_.open_[map.first + static_cast<std::size_t>(y * map.width + x)] = open_from(p, map.n, reach);
      }
    }
  });
  workers.run(static_cast<int>(scene_.parts.size()), [&](int index) {
    const Mesh& mesh = scene_.parts[static_cast<std::size_t>(index)].mesh;
    std::vector<float>& open = surfaces_.parts_[static_cast<std::size_t>(index)].open_at_corner;
    for (std::size_t i = 0; i < open.size(); ++i) open[i] = open_from(mesh.position_m[i], mesh.normal[i], reach);
  });
}

}  // namespace cgsr::sim
