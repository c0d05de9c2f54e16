#pragma once

#include <functional>

#include <Eigen/Core>

#include "hal/sim/render/renderer.h"

namespace cgsr::sim {

/// One pixel's ray and the nearest surface of the kind that was asked for.
struct PixelRay {
  int x = 0;
  int y = 0;
  Met met;
  float depth_m = 0.0F;       ///< of what was met; 0: nothing.
  Eigen::Vector3f direction;  ///< unit depth, world.
};

struct PixelRange {
  int left;
  int top;
  int right;   ///< beyond the last.
  int bottom;  ///< beyond the last.
  int stride = 1;
};

/// Casts the rays of one row of pixels, eight at a time, and hands each to `take`.
void cast_row(const Renderer& renderer, const Pose& X_WC, const PixelRange& range, int y, unsigned kind,
              const std::function<void(const PixelRay&)>& take);

/// A point just before the surface along the ray, outside it.
Eigen::Vector3f just_before(const Eigen::Vector3f& origin, const PixelRay& ray);

/// Does `from` see `to`, for rays of this kind?
bool sees(const Tracer& tracer, const Eigen::Vector3f& from, const Eigen::Vector3f& to, unsigned kind);

}  // namespace cgsr::sim
