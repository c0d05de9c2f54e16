#pragma once

#include <Eigen/Core>

#include "hal/sim/scene/material.h"

namespace cgsr::sim {

/// A place on a surface and how much of it one ray stands for.
struct SurfacePoint {
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  Eigen::Vector2f width = Eigen::Vector2f::Zero();  ///< of the ray's footprint along u and v, same units.
};

/// The share of the material's second albedo at a place, averaged over the footprint (exactly for checker, stripes and tape; others
/// fade to their mean as they get finer than it), so that far patterns do not flicker. kPlain: 0.
float second_share(const Material& material, const SurfacePoint& at);

/// The albedo of a surface there: pattern or texture.
Rgb albedo_at(const Material& material, const std::vector<Texture>& textures, const SurfacePoint& at);

/// Trilinear: between the two mip levels whose texels are nearest the footprint's wider side.
Rgb sample(const Texture& texture, const SurfacePoint& at);

}  // namespace cgsr::sim
