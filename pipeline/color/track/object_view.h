#pragma once

#include <array>
#include <cstdint>

#include "pipeline/color/learn/light.h"
#include "pipeline/imaging/pyramid.h"
#include "platform/box.h"

namespace cgsr::color {

/// What a box shows, in 32x32 pixels whatever its size: the colours of the object without its surroundings.
/// Planes are row by row, as the camera coded them.
struct ObjectView {
  static constexpr imaging::PatchSize kSize{32, 32};
  using Plane = std::array<std::uint8_t, std::size_t{32} * 32>;
  Plane y, u, v;
};

/// \param box  in camera pixels; its outer tenth is left out, where the surroundings look in.
ObjectView view_object(const imaging::Pyramid& image, const Box& box);

/// The whole image in as many pixels.
ObjectView view_image(const imaging::Pyramid& image);

/// The same as a light that is `gain` times as bright in R, G and B would show it (the diagonal model, Eq. 3.1).
ObjectView relit(const ObjectView& view, const Light& gain);

}  // namespace cgsr::color
