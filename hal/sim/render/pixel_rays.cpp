#include "hal/sim/render/pixel_rays.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "hal/sim/render/visibility.h"

namespace cgsr::sim {

using Eigen::Vector3f;

void cast_row(const Renderer& renderer, const Pose& X_WC, const PixelRange& range, int y, unsigned kind,
              const std::function<void(const PixelRay&)>& take) {
  const Eigen::Matrix3f R = X_WC.linear().cast<float>();
  const Vector3f origin = X_WC.translation().cast<float>();
  std::array<PixelRay, kPacket> pixels;
  int count = 0;
  const auto flush = [&] {
    alignas(32) int valid[kPacket] = {};
    alignas(32) RTCRayHit8 rays{};
    for (int lane = 0; lane < count; ++lane) {
      const Vector3f& d = pixels[static_cast<std::size_t>(lane)].direction;
      valid[lane] = -1;
      rays.ray.org_x[lane] = origin.x();
      rays.ray.org_y[lane] = origin.y();
      rays.ray.org_z[lane] = origin.z();
      rays.ray.dir_x[lane] = d.x();
      rays.ray.dir_y[lane] = d.y();
      rays.ray.dir_z[lane] = d.z();
      rays.ray.tnear[lane] = 0.01F;
      rays.ray.tfar[lane] = kMaxDepth_m;
      rays.ray.mask[lane] = kind;
      rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    renderer.tracer().nearest(valid, rays, true);
    for (int lane = 0; lane < count; ++lane) {
      PixelRay& pixel = pixels[static_cast<std::size_t>(lane)];
      pixel.met = renderer.tracer().met(rays, lane);
      pixel.depth_m = pixel.met.part < 0 ? 0.0F : rays.ray.tfar[lane];
      take(pixel);
    }
    count = 0;
  };
  for (int x = range.left + range.stride / 2; x < range.right; x += range.stride) {
    PixelRay& pixel = pixels[static_cast<std::size_t>(count++)];
    pixel.x = x;
    pixel.y = y;
    pixel.direction = R * renderer.rays().direction(x, y, Eigen::Vector2f::Zero());
    if (count == kPacket) flush();
  }
  if (count > 0) flush();
}

bool sees(const Tracer& tracer, const Vector3f& from, const Vector3f& to, unsigned kind) {
  ShadowQuery query;
  query.wanted[0] = true;
  query.from[0] = from;
  return !centre_hidden(tracer, query, to, kind)[0];
}

Vector3f just_before(const Vector3f& origin, const PixelRay& ray) {
  return origin + ray.direction * (ray.depth_m - 3e-4F * std::max(1.0F, ray.depth_m));
}

}  // namespace cgsr::sim
