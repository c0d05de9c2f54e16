#include "hal/sim/scene/material.h"

#include <algorithm>
#include <cstddef>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {

Rgb from_srgb(const std::array<double, 3>& encoded) {
  return {static_cast<float>(srgb_decode(encoded[0])), static_cast<float>(srgb_decode(encoded[1])),
          static_cast<float>(srgb_decode(encoded[2]))};
}

Texture make_texture(int width_px, int height_px, std::vector<float> rgb) {
  Texture texture;
  texture.levels.push_back({width_px, height_px, std::move(rgb)});
  while (std::min(texture.levels.back().width_px, texture.levels.back().height_px) > 1) {
    const Texture::Level& below = texture.levels.back();
    Texture::Level level{below.width_px / 2, below.height_px / 2, {}};
    level.rgb.reserve(static_cast<std::size_t>(level.width_px) * static_cast<std::size_t>(level.height_px) * 3);
    const auto texel = [&below](int x, int y, int channel) {
      return below
          .rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(below.width_px) + static_cast<std::size_t>(x)) *
                   3 +
               static_cast<std::size_t>(channel)];
    };
    for (int y = 0; y < level.height_px; ++y) {
      for (int x = 0; x < level.width_px; ++x) {
        for (int c = 0; c < 3; ++c) {
          level.rgb.push_back(0.25F * (texel(2 * x, 2 * y, c) + texel(2 * x + 1, 2 * y, c) +
                                       texel(2 * x, 2 * y + 1, c) + texel(2 * x + 1, 2 * y + 1, c)));
        }
      }
    }
    texture.levels.push_back(std::move(level));
  }
  return texture;
}

}  // namespace cgsr::sim
