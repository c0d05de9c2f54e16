#include "hal/sim/people/identity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hal/sim/scene/portable_math.h"

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

/// Numbers that belong to somebody: the n-th is the same whatever else is drawn.
class Draws {
 public:
  explicit Draws(std::uint32_t seed) : seed_(seed) {}
  float between(float low, float high) { return low + (high - low) * unit(mix(seed_, next_++)); }

 private:
  std::uint32_t seed_;
  std::uint32_t next_ = 0;
};

// One of the shipped skins or between two of them, by how dark it is.
Rgb skin_of(float darkness, const std::array<Identity, kIdentities>& faces) {
  const float at = darkness * (kIdentities - 1);
  const auto lighter = std::min(static_cast<std::size_t>(at), faces.size() - 2);
  const float share = at - static_cast<float>(lighter);
  return (1.0F - share) * faces[lighter].skin + share * faces[lighter + 1].skin;
}

// Within what the shipped faces span and a little beyond it; the mouth keeps its distance from the nose.
Identity drawn(int number, const std::array<Identity, kIdentities>& faces) {
  Identity who;
  Draws draws(static_cast<std::uint32_t>(number));
  const float darkness = draws.between(0.0F, 1.0F);
  who.skin = skin_of(darkness, faces);
  const auto first = static_cast<std::size_t>(std::floor(4.0F * darkness));  // of four shipped ones about as dark
  who.hair = draws.between(0.7F, 1.3F) * faces[first + static_cast<std::size_t>(draws.between(0.0F, 3.99F))].hair;
  who.skin_contrast = draws.between(0.45F, 0.7F);
  who.width = draws.between(0.96F, 1.05F);
  who.height = draws.between(0.97F, 1.04F);
  who.jaw = draws.between(0.19F, 0.33F);
  who.eye_apart_m = draws.between(0.0305F, 0.0340F);
  who.nose_length_m = draws.between(0.034F, 0.040F);
  who.nose_width = draws.between(0.92F, 1.2F);
  who.mouth_width_m = draws.between(0.0215F, 0.0275F);
  who.mouth_down_m = who.nose_length_m + draws.between(0.024F, 0.029F);
  who.lip_red = draws.between(0.3F, 0.9F);
  who.brow_up_m = draws.between(0.019F, 0.0235F);
  who.brow_thick_m = draws.between(0.003F, 0.0057F);
  who.hairline_m = draws.between(0.061F, 0.074F);
  who.hair_back_m = draws.between(-0.11F, -0.055F);
  who.beard = std::max(0.0F, draws.between(-0.5F, 0.5F));
  who.glasses = draws.between(0.0F, 1.0F) < 0.25F;
  return who;
}

}  // namespace

Identity identity(int index) {
  static const auto faces = make_faces();
  static const auto outfits = make_outfits();
  const int number = std::clamp(index, 0, kLastIdentity);
  Identity who = number < kIdentities ? faces[static_cast<std::size_t>(number)] : drawn(number, faces);
  who.seed = 1000U + static_cast<std::uint32_t>(number) * 77U;
  who.outfit = outfits[static_cast<std::size_t>(number % kIdentities)];
  return who;
}

}  // namespace cgsr::sim
