#include "hal/sim/people/identity.h"

#include <algorithm>
#include <array>

namespace cgsr::sim {
namespace {

Rgb rgb(double r, double g, double b) {
  return from_srgb({r, g, b});
}

Outfit wears(ShirtKind kind, const Rgb& color, const Rgb& second, const Rgb& trousers) {
  return {kind, color, second, trousers, -1, -1};
}

// From light to dark skin.
std::array<Identity, kIdentities> make_faces() {
  return {{{.skin = Rgb(0.68F, 0.47F, 0.36F), .hair = rgb(0.70, 0.55, 0.33), .jaw = 0.28F},
           {.skin = Rgb(0.64F, 0.42F, 0.31F),
            .hair = rgb(0.22, 0.15, 0.11),
            .skin_contrast = 0.55F,
            .width = 1.04F,
            .jaw = 0.20F,
            .eye_apart_m = 0.0335F,
            .brow_thick_m = 0.0055F,
            .beard = 0.5F},
           {.skin = Rgb(0.57F, 0.36F, 0.25F),
            .hair = rgb(0.12, 0.10, 0.10),
            .skin_contrast = 0.6F,
            .height = 1.03F,
            .nose_width = 1.15F,
            .hairline_m = 0.074F,
            .glasses = true},
           {.skin = Rgb(0.52F, 0.33F, 0.23F),
            .hair = rgb(0.45, 0.22, 0.10),
            .width = 0.97F,
            .jaw = 0.32F,
            .eye_apart_m = 0.031F,
            .mouth_width_m = 0.022F,
            .lip_red = 0.9F,
            .brow_thick_m = 0.003F,
            .hair_back_m = -0.11F},
           {.skin = Rgb(0.44F, 0.27F, 0.18F),
            .hair = rgb(0.08, 0.07, 0.07),
            .skin_contrast = 0.65F,
            .nose_length_m = 0.039F,
            .mouth_down_m = 0.065F,
            .hairline_m = 0.061F},
           {.skin = Rgb(0.36F, 0.22F, 0.15F),
            .hair = rgb(0.44, 0.43, 0.42),
            .skin_contrast = 0.6F,
            .width = 0.99F,
            .brow_up_m = 0.022F,
            .beard = 0.22F,
            .glasses = true},
           {.skin = Rgb(0.27F, 0.165F, 0.115F),
            .hair = rgb(0.06, 0.055, 0.05),
            .skin_contrast = 0.65F,
            .nose_width = 1.1F,
            .mouth_width_m = 0.026F,
            .lip_red = 0.7F,
            .hair_back_m = -0.09F},
           {.skin = Rgb(0.19F, 0.125F, 0.09F),
            .hair = rgb(0.05, 0.045, 0.045),
            .skin_contrast = 0.7F,
            .nose_width = 1.2F,
            .mouth_width_m = 0.027F,
            .hairline_m = 0.070F,
            .beard = 0.3F}}};
}

std::array<Outfit, kIdentities> make_outfits() {
  const auto jeans = rgb(0.22, 0.28, 0.40);
  const auto black = rgb(0.12, 0.12, 0.13);
  const auto beige = rgb(0.66, 0.58, 0.45);
  const auto white = rgb(0.93, 0.93, 0.92);
  return {wears(ShirtKind::kPlain, rgb(0.10, 0.22, 0.62), white, jeans),
          wears(ShirtKind::kStriped, rgb(0.75, 0.12, 0.12), white, black),
          wears(ShirtKind::kPlain, rgb(0.90, 0.74, 0.12), white, jeans),
          wears(ShirtKind::kTwoColoured, rgb(0.15, 0.52, 0.28), rgb(0.88, 0.85, 0.75), beige),
          wears(ShirtKind::kPlain, rgb(0.86, 0.42, 0.12), white, black),
          wears(ShirtKind::kStriped, rgb(0.20, 0.42, 0.72), rgb(0.90, 0.90, 0.88), beige),
          wears(ShirtKind::kTwoColoured, rgb(0.55, 0.15, 0.48), rgb(0.20, 0.20, 0.24), jeans),
          wears(ShirtKind::kPlain, white, white, black)};
}

}  // namespace

Identity identity(int index) {
  static const auto faces = make_faces();
  static const auto outfits = make_outfits();
  const auto number = static_cast<std::size_t>(std::clamp(index, 0, kIdentities - 1));
  Identity who = faces[number];
  who.outfit = outfits[number];
  who.seed = 1000U + static_cast<std::uint32_t>(index) * 77U;
  return who;
}

}  // namespace cgsr::sim
