#include "hal/sim/people/identity.h"

#include <algorithm>
#include <array>

namespace cgsr::sim {
namespace {

Rgb rgb(double r, double g, double b) {
  return from_srgb({r, g, b});
}

Outfit wears(ShirtKind kind, const Rgb& color, const Rgb& second, const Rgb& trousers) {
  return {kind, color, second, trousers, -1};
}

}  // namespace

Identity identity(int index) {
  const auto jeans = rgb(0.22, 0.28, 0.40);
  const auto black = rgb(0.12, 0.12, 0.13);
  const auto beige = rgb(0.66, 0.58, 0.45);
  const auto white = rgb(0.93, 0.93, 0.92);
  Identity id;
  id.seed = 1000U + static_cast<std::uint32_t>(index) * 77U;
  switch (std::clamp(index, 0, kIdentities - 1)) {
    case 0:
      id.skin = Rgb(0.68F, 0.47F, 0.36F);
      id.hair = rgb(0.70, 0.55, 0.33);
      id.jaw = 0.28F;
      id.outfit = wears(ShirtKind::kPlain, rgb(0.10, 0.22, 0.62), white, jeans);
      break;
    case 1:
      id.skin = Rgb(0.64F, 0.42F, 0.31F);
      id.hair = rgb(0.22, 0.15, 0.11);
      id.beard = 0.5F;
      id.width = 1.04F;
      id.jaw = 0.20F;
      id.skin_contrast = 0.55F;
      id.eye_apart_m = 0.0335F;
      id.brow_thick_m = 0.0055F;
      id.outfit = wears(ShirtKind::kStriped, rgb(0.75, 0.12, 0.12), white, black);
      break;
    case 2:
      id.skin = Rgb(0.57F, 0.36F, 0.25F);
      id.hair = rgb(0.12, 0.10, 0.10);
      id.glasses = true;
      id.height = 1.03F;
      id.nose_width = 1.15F;
      id.skin_contrast = 0.6F;
      id.hairline_m = 0.074F;
      id.outfit = wears(ShirtKind::kPlain, rgb(0.90, 0.74, 0.12), white, jeans);
      break;
    case 3:
      id.skin = Rgb(0.52F, 0.33F, 0.23F);
      id.hair = rgb(0.45, 0.22, 0.10);
      id.hair_back_m = -0.11F;
      id.width = 0.97F;
      id.jaw = 0.32F;
      id.lip_red = 0.9F;
      id.mouth_width_m = 0.022F;
      id.eye_apart_m = 0.031F;
      id.brow_thick_m = 0.003F;
      id.outfit = wears(ShirtKind::kTwoColoured, rgb(0.15, 0.52, 0.28), rgb(0.88, 0.85, 0.75), beige);
      break;
    case 4:
      id.skin = Rgb(0.44F, 0.27F, 0.18F);
      id.hair = rgb(0.08, 0.07, 0.07);
      id.hairline_m = 0.061F;
      id.skin_contrast = 0.65F;
      id.nose_length_m = 0.039F;
      id.mouth_down_m = 0.065F;
      id.outfit = wears(ShirtKind::kPlain, rgb(0.86, 0.42, 0.12), white, black);
      break;
    case 5:
      id.skin = Rgb(0.36F, 0.22F, 0.15F);
      id.hair = rgb(0.44, 0.43, 0.42);
      id.glasses = true;
      id.beard = 0.22F;
      id.width = 0.99F;
      id.brow_up_m = 0.022F;
      id.skin_contrast = 0.6F;
      id.outfit = wears(ShirtKind::kStriped, rgb(0.20, 0.42, 0.72), rgb(0.90, 0.90, 0.88), beige);
      break;
    case 6:
      id.skin = Rgb(0.27F, 0.165F, 0.115F);
      id.hair = rgb(0.06, 0.055, 0.05);
      id.hair_back_m = -0.09F;
      id.lip_red = 0.7F;
      id.nose_width = 1.1F;
      id.mouth_width_m = 0.026F;
      id.skin_contrast = 0.65F;
      id.outfit = wears(ShirtKind::kTwoColoured, rgb(0.55, 0.15, 0.48), rgb(0.20, 0.20, 0.24), jeans);
      break;
    default:
      id.skin = Rgb(0.19F, 0.125F, 0.09F);
      id.hair = rgb(0.05, 0.045, 0.045);
      id.beard = 0.3F;
      id.nose_width = 1.2F;
      id.mouth_width_m = 0.027F;
      id.hairline_m = 0.070F;
      id.skin_contrast = 0.7F;
      id.outfit = wears(ShirtKind::kPlain, white, white, black);
      break;
  }
  return id;
}

}  // namespace cgsr::sim
