#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "hal/sim/people/head.h"
#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

constexpr int kWidth = 1024;
constexpr int kHeight = 512;
constexpr float kPaint = 1.6F;  // all painted shading is that much stronger than on skin

float bell(float y, float z, float y0, float z0, float half_width, float half_height) {
  const float a = (y - y0) / half_width;
  const float b = (z - z0) / half_height;
  const float square = a * a + b * b;
  return square > 12.0F ? 0.0F : static_cast<float>(exponential(-static_cast<double>(square)));
}

// 1 inside, 0 outside, over about a millimetre.
float inside(float distance_m) {
  return std::clamp(0.5F - distance_m / 0.001F, 0.0F, 1.0F);
}

float noise(float y, float z, float size_m, std::uint32_t seed) {
  const float a = y / size_m;
  const float b = z / size_m;
  const float a0 = std::floor(a);
  const float b0 = std::floor(b);
  const auto at = [&](float da, float db) {
    return unit(mix(static_cast<std::uint32_t>(static_cast<std::int32_t>(a0 + da)),
                    static_cast<std::uint32_t>(static_cast<std::int32_t>(b0 + db)), seed));
  };
  const float fa = (a - a0) * (a - a0) * (3 - 2 * (a - a0));
  const float fb = (b - b0) * (b - b0) * (3 - 2 * (b - b0));
  const float low = at(0, 0) + fa * (at(1, 0) - at(0, 0));
  const float high = at(0, 1) + fa * (at(1, 1) - at(0, 1));
  return low + fb * (high - low) - 0.5F;
}

// What the painter does to the skin: a factor.
float shading(const Identity& id, float y, float z) {
  const float side = std::abs(y);
  const float nose_end = -id.nose_length_m;
  float light = 1.0F;
  light -= kPaint * 0.34F * bell(side, z, id.eye_apart_m, 0.004F, 0.020F, 0.013F);
  light -= kPaint * 0.20F * bell(side, z, 0.014F, 0.002F, 0.006F, 0.008F);
  light -= kPaint * 0.22F * bell(side, z, 0.015F * id.nose_width, -0.020F, 0.005F, 0.016F);
  light -= kPaint * 0.30F * bell(y, z, 0.0F, nose_end - 0.004F, 0.014F * id.nose_width, 0.005F);
  light -= kPaint * 0.22F * bell(y, z, 0.0F, -id.mouth_down_m - 0.014F, 0.018F, 0.005F);
  light += kPaint * 0.12F * bell(y, z, 0.0F, -0.010F, 0.006F, 0.026F);
  light += kPaint * 0.10F * bell(side, z, 0.040F, -0.030F, 0.016F, 0.014F);
  return std::max(0.15F, light);
}

void blend(Rgb& color, const Rgb& other, float share) {
  color += std::clamp(share, 0.0F, 1.0F) * (other - color);
}

void paint_eye(const Identity& id, float y, float z, Rgb& color) {
  const float across = (std::abs(y) - id.eye_apart_m) / 0.0145F;
  if (std::abs(across) > 1.3F) return;
  const float lid = 0.0058F * (1.0F - across * across);  // half height of the opening
  const float open = inside(std::abs(z) - lid);
  const float toward = std::abs(y) - id.eye_apart_m;
  const float from_iris = std::sqrt(toward * toward + z * z) - 0.006F;
  Rgb eye = Rgb::Constant(0.6F);
  blend(eye, Rgb(0.05F, 0.045F, 0.04F), inside(from_iris));
  blend(color, eye, open);
  const float lash = std::abs(z - std::max(0.0F, lid)) - 0.0011F;
  if (std::abs(across) < 1.05F) blend(color, Rgb::Constant(0.03F), inside(lash));
}

void paint_hair(const Identity& id, const OnHead& at, float y, float z, Rgb& color) {
  const float side = std::abs(y);
  const float thick = id.brow_thick_m * (1.1F - 6.0F * std::max(0.0F, side - 0.030F));
  const float arch = id.brow_up_m + 0.10F * (side - 0.016F) -
                     5.0F * std::max(0.0F, side - 0.036F) * std::max(0.0F, side - 0.036F) * 10.0F;
  if (at.front > 0.0 && side > 0.013F && side < 0.052F)
    blend(color, 0.6F * id.hair, 0.95F * inside(std::abs(z - arch) - thick / 2));
  const auto front = static_cast<float>(at.front);
  // The hairline falls from the brow over the temples to the ears and runs along the neck behind.
  const float temple = std::clamp((0.62F - front) / 0.45F, 0.0F, 1.0F);
  const float line =
      id.hairline_m + temple * (id.hair_back_m - id.hairline_m) + 0.003F * noise(y, front * 0.1F, 0.004F, id.seed + 5U);
  Rgb strand = id.hair * (1.0F + 0.5F * noise(y, z * 0.2F, 0.0025F, id.seed + 6U));
  blend(color, strand, std::clamp((z - line) / 0.004F, 0.0F, 1.0F));
  if (id.beard > 0.0F && front > -0.1F) {
    const float moustache = bell(y, z, 0.0F, -0.5F * (id.nose_length_m + id.mouth_down_m) - 0.003F, 0.026F, 0.006F);
    const float cheek = std::clamp((-0.045F - 0.35F * std::max(0.0F, 0.05F - side) - z) / 0.012F, 0.0F, 1.0F);
    const float mouth = bell(y, z, 0.0F, -id.mouth_down_m, id.mouth_width_m, 0.010F);
    const float grown = std::max(moustache, cheek * (1.0F - mouth));
    blend(color, id.hair, id.beard * grown * (0.85F + 0.3F * noise(y, z, 0.0015F, id.seed + 7U)));
  }
}

void paint_mouth(const Identity& id, float y, float z, Rgb& color) {
  const float across = y / id.mouth_width_m;
  if (std::abs(across) > 1.0F) return;
  const float off = z + id.mouth_down_m;
  const float bow = 1.0F - across * across;
  const float upper = 0.0065F * bow * (0.75F + 0.25F * std::abs(across));
  const float lower = 0.0080F * bow;
  const Rgb lip = color.cwiseProduct(Rgb(0.85F, 0.85F - 0.45F * id.lip_red, 0.85F - 0.40F * id.lip_red));
  blend(color, lip, inside(off > 0.0F ? off - upper : -off - lower));
  blend(color, Rgb(0.06F, 0.03F, 0.03F), 0.9F * inside(std::abs(off) - 0.0011F));
}

void paint_glasses(const Identity& id, float y, float z, Rgb& color) {
  const float side = std::abs(y);
  const float a = (side - id.eye_apart_m) / 0.0225F;
  const float b = (z + 0.001F) / 0.0165F;
  const float ring = std::abs(std::sqrt(a * a + b * b) - 1.0F) * 0.018F - 0.0011F;
  const float bridge = side < id.eye_apart_m - 0.020F ? std::abs(z - 0.004F) - 0.0011F : 1.0F;
  const float temple = side > id.eye_apart_m + 0.022F ? std::abs(z - 0.004F) - 0.0011F : 1.0F;
  blend(color, Rgb::Constant(0.03F), inside(std::min({ring, bridge, temple})));
}

void paint_moles(const Identity& id, float y, float z, Rgb& color) {
  for (std::uint32_t i = 0; i < 10; ++i) {
    const float my = 0.110F * (unit(mix(id.seed, i, 1U)) - 0.5F);
    const float mz = -0.085F + 0.145F * unit(mix(id.seed, i, 2U));
    const float r = 0.0010F + 0.0006F * unit(mix(id.seed, i, 3U));
    const float d = std::sqrt((y - my) * (y - my) + (z - mz) * (z - mz)) - r;
    blend(color, 0.3F * id.skin, 0.85F * inside(d));
  }
}

Rgb paint(const Identity& id, const OnHead& at) {
  const auto y = static_cast<float>(at.y_m);
  const auto z = static_cast<float>(at.z_m);
  Rgb color = id.skin;
  const float pattern = 0.6F * noise(y, z, 0.0077F, id.seed) + 0.4F * noise(y, z, 0.0038F, id.seed + 1U);
  color *= 1.0F + id.skin_contrast * pattern;
  if (at.front > 0.0) {
    color *= shading(id, y, z);
    paint_mouth(id, y, z, color);
    paint_moles(id, y, z, color);
    paint_eye(id, y, z, color);
  }
  paint_hair(id, at, y, z, color);
  if (id.glasses && at.front > 0.05) paint_glasses(id, y, z, color);
  return color.cwiseMax(0.01F).cwiseMin(0.95F);
}

}  // namespace

Texture face_texture(const Identity& id) {
  std::vector<float> rgb;
  rgb.reserve(static_cast<std::size_t>(kWidth) * kHeight * 3);
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const Rgb color = paint(id, on_head(2.0 * (column + 0.5) / kWidth - 1.0, 1.0 - 2.0 * (row + 0.5) / kHeight));
      rgb.insert(rgb.end(), {color[0], color[1], color[2]});
    }
  }
  return make_texture(kWidth, kHeight, std::move(rgb));
}

}  // namespace cgsr::sim
