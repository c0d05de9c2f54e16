#include "hal/sim/render/truth_images.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include "hal/sim/render/pixel_rays.h"
#include "hal/sim/render/visibility.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector3f;

// Does any of the points before `depth_m`, a step apart, have the lamp hidden behind the map?
bool any_hidden(const Tracer& tracer, const Vector3f& origin, const PixelRay& ray, const Vector3f& p_WL, float step_m) {
  const float length = ray.depth_m * ray.direction.norm();
  const int steps = std::max(1, static_cast<int>(length / step_m));
  for (int first = 0; first < steps; first += kPacket) {
    ShadowQuery query;
    for (int lane = 0; lane < kPacket && first + lane < steps; ++lane) {
      const auto i = static_cast<std::size_t>(lane);
      query.wanted[i] = true;
      query.from[i] = origin + ray.direction * (ray.depth_m * (static_cast<float>(first + lane) + 0.5F) /
                                                static_cast<float>(steps));
    }
    const auto hidden = centre_hidden(tracer, query, p_WL, kMapRays);
    if (std::any_of(hidden.begin(), hidden.end(), [](bool h) { return h; })) return true;
  }
  return false;
}

}  // namespace

ShadowMasks shadow_masks(Renderer& renderer, const SceneState& state, const Pose& X_WC, int lamp,
                         const ShadowMaskOptions& options) {
  const CameraModel& camera = renderer.camera();
  const Vector3f p_WL = state.lamps[static_cast<std::size_t>(lamp)].p_WL.cast<float>();
  const Vector3f origin = X_WC.translation().cast<float>();
  const int stride = std::max(1, options.stride_px);
  ShadowMasks masks;
  masks.width_px = camera.width_px;
  masks.height_px = camera.height_px;
  const auto pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  masks.surface_shaded.assign(pixels, 0);
  masks.possibly_shaded.assign(pixels, 0);

  const auto fill = [&](std::vector<std::uint8_t>& mask, int x, int y) {
    const int left = x - stride / 2;
    const int top = y - stride / 2;
    for (int row = top; row < std::min(top + stride, camera.height_px); ++row) {
      for (int column = left; column < std::min(left + stride, camera.width_px); ++column) {
        mask[static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width_px) +
             static_cast<std::size_t>(column)] = 255;
      }
    }
  };
  const PixelRange all{0, 0, camera.width_px, camera.height_px, stride};
  renderer.workers().run((camera.height_px - stride / 2 + stride - 1) / stride, [&](int job) {
    cast_row(renderer, X_WC, all, job * stride + stride / 2, kMapRays, [&](const PixelRay& ray) {
      if (ray.met.part < 0) return;
      const bool surface = !sees(renderer.tracer(), just_before(origin, ray), p_WL, kMapRays);
      if (surface) fill(masks.surface_shaded, ray.x, ray.y);
      if (surface || any_hidden(renderer.tracer(), origin, ray, p_WL, static_cast<float>(options.step_m))) {
        fill(masks.possibly_shaded, ray.x, ray.y);
      }
    });
  });
  return masks;
}

}  // namespace cgsr::sim
