#include "hal/sim/render/pattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

constexpr float kSharp = 1e-6F;  // a footprint narrower than this share of the period is a point

float fraction(float x) {
  return x - std::floor(x);
}

// Integral from 0 to x of the pulse train that is 1 on [0, duty) of each unit period.
float pulse_integral(float x, float duty) {
  const float whole = std::floor(x);
  return whole * duty + std::min(x - whole, duty);
}

// Mean over [x - width/2, x + width/2] of that pulse train.
float pulse(float x, float width, float duty) {
  if (width < kSharp) return fraction(x) < duty ? 1.0F : 0.0F;
  return (pulse_integral(x + width / 2, duty) - pulse_integral(x - width / 2, duty)) / width;
}

std::uint32_t cell(float x) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(x));
}

// Smooth noise in [0, 1] on a unit lattice.
float value_noise(float x, float y, std::uint32_t seed) {
  const float x0 = std::floor(x);
  const float y0 = std::floor(y);
  const float fx = x - x0;
  const float fy = y - y0;
  const float sx = fx * fx * (3.0F - 2.0F * fx);
  const float sy = fy * fy * (3.0F - 2.0F * fy);
  const auto at = [&](float dx, float dy) { return unit(mix(cell(x0 + dx), cell(y0 + dy), seed)); };
  const float low = at(0, 0) + sx * (at(1, 0) - at(0, 0));
  const float high = at(0, 1) + sx * (at(1, 1) - at(0, 1));
  return low + sy * (high - low);
}

// 1 while a detail of `size` is wider than two footprints, 0 once it is narrower than one half.
float resolved(float size, float footprint) {
  return std::clamp((size / std::max(footprint, 1e-9F) - 0.5F) / 1.5F, 0.0F, 1.0F);
}

// Lines of words: each line is 1.6 letters high, letters are 0.6 wide, a word gap every few letters, blank lines now and then.
float print_share(const Material& m, const SurfacePoint& at) {
  const float line_height = 1.6F * m.size_m;
  const float letter_width = 0.6F * m.size_m;
  const float line = std::floor(at.uv.y() / line_height);
  const float letter = std::floor(at.uv.x() / letter_width);
  constexpr float kMean = 0.22F;
  float ink = 0.0F;
  const bool blank_line = unit(mix(cell(line), 77U)) < 0.15F;
  const bool gap = unit(mix(cell(letter), cell(line), 5U)) < 0.18F;
  const float height = fraction(at.uv.y() / line_height);
  if (!blank_line && !gap && height > 0.25F && height < 0.85F) {
    // A letter is a 3 x 5 matrix of dots, a bit more than half of them black.
    const float column = std::floor(3.6F * fraction(at.uv.x() / letter_width));
    const float row = std::floor((height - 0.25F) / 0.6F * 5.0F);
    const std::uint32_t letter_id = mix(cell(letter), cell(line), 9U) % 26U;
    if (column < 3.0F && unit(mix(letter_id, cell(column), cell(row))) < 0.55F) ink = 1.0F;
  }
  const float clear = resolved(0.3F * m.size_m, std::max(at.width.x(), at.width.y()));
  return kMean + clear * (ink - kMean);
}

float wood_share(const Material& m, const SurfacePoint& at) {
  const float plank = std::floor(at.uv.y() / m.size_m);
  const float shift = 3.0F * unit(mix(cell(plank), 11U));
  const float length = 9.0F * m.size_m;
  const float board = std::floor(at.uv.x() / length + shift);
  const std::uint32_t id = mix(cell(plank), cell(board), 3U);
  const float tone = unit(id);
  const float offset = 100.0F * unit(mix(id, 1U));
  const float footprint = std::max(at.width.x(), at.width.y());
  const float grain = value_noise(at.uv.x() / 0.16F + offset, at.uv.y() / 0.006F, id) - 0.5F;
  const float flame = value_noise(at.uv.x() / 0.5F + offset, at.uv.y() / 0.03F, id + 1U) - 0.5F;
  const float seam_v =
      pulse(at.uv.y() / m.size_m + 0.5F * 0.002F / m.size_m, at.width.y() / m.size_m, 0.002F / m.size_m);
  const float seam_u = pulse(at.uv.x() / length + shift, at.width.x() / length, 0.002F / length);
  const float share = 0.25F + 0.45F * (tone - 0.3F) + 0.35F * resolved(0.006F, at.width.y()) * grain +
                      0.35F * resolved(0.03F, footprint) * flame;
  return std::clamp(share + 0.8F * std::max(seam_u, seam_v), 0.0F, 1.0F);
}

float fabric_share(const Material& m, const SurfacePoint& at) {
  const float footprint = std::max(at.width.x(), at.width.y());
  float share = 0.5F;
  float size = m.size_m;
  for (std::uint32_t octave = 0; octave < 3; ++octave, size *= 0.4F) {
    const float clear = resolved(size, footprint);
    if (clear <= 0.0F) break;
    share += 0.5F * clear * (value_noise(at.uv.x() / size, at.uv.y() / size, octave) - 0.5F);
  }
  return std::clamp(share, 0.0F, 1.0F);
}

}  // namespace

float second_share(const Material& m, const SurfacePoint& at) {
  const float period = m.size_m;
  switch (m.pattern) {
    case PatternKind::kPlain:
      return 0.0F;
    case PatternKind::kChecker: {
      const float a = pulse(at.uv.x() / (2 * period), at.width.x() / (2 * period), 0.5F);
      const float b = pulse(at.uv.y() / (2 * period), at.width.y() / (2 * period), 0.5F);
      return a + b - 2.0F * a * b;
    }
    case PatternKind::kStripes:
      return pulse(at.uv.x() / period, at.width.x() / period, m.width);
    case PatternKind::kTape: {
      const float duty = m.width / period;
      const float a = pulse(at.uv.x() / period + duty / 2, at.width.x() / period, duty);
      const float b = pulse(at.uv.y() / period + duty / 2, at.width.y() / period, duty);
      return a + b - a * b;
    }
    case PatternKind::kPrint:
      return print_share(m, at);
    case PatternKind::kWood:
      return wood_share(m, at);
    case PatternKind::kFabric:
      return fabric_share(m, at);
  }
  return 0.0F;
}

Rgb sample(const Texture& texture, const SurfacePoint& at) {
  const Texture::Level& base = texture.levels.front();
  const float texels = std::max(
      {1.0F, at.width.x() * static_cast<float>(base.width_px), at.width.y() * static_cast<float>(base.height_px)});
  // log2 by halving: the level below which a texel is narrower than the footprint, and how far towards the next.
  int level = 0;
  float rest = texels;
  const int last = static_cast<int>(texture.levels.size()) - 1;
  while (rest >= 2.0F && level < last) {
    rest *= 0.5F;
    ++level;
  }
  const auto bilinear = [&](int index) {
    const Texture::Level& image = texture.levels[static_cast<std::size_t>(index)];
    const float x = fraction(at.uv.x()) * static_cast<float>(image.width_px) - 0.5F;
    const float y = fraction(at.uv.y()) * static_cast<float>(image.height_px) - 0.5F;
    const float x0 = std::floor(x);
    const float y0 = std::floor(y);
    const auto texel = [&](float column, float row) {
      const int c = (static_cast<int>(column) + image.width_px) % image.width_px;
      const int r = (static_cast<int>(row) + image.height_px) % image.height_px;
      return Rgb(
          Eigen::Map<const Rgb>(&image.rgb[(static_cast<std::size_t>(r) * static_cast<std::size_t>(image.width_px) +
                                            static_cast<std::size_t>(c)) *
                                           3]));
    };
    const Rgb top = texel(x0, y0) + (x - x0) * (texel(x0 + 1, y0) - texel(x0, y0));
    const Rgb bottom = texel(x0, y0 + 1) + (x - x0) * (texel(x0 + 1, y0 + 1) - texel(x0, y0 + 1));
    return Rgb(top + (y - y0) * (bottom - top));
  };
  Rgb fine = bilinear(level);
  if (level == last || rest <= 1.0F) return fine;
  return fine + (rest - 1.0F) * (bilinear(level + 1) - fine);
}

Rgb albedo_at(const Material& material, const std::vector<Texture>& textures, const SurfacePoint& at) {
  if (material.texture >= 0) return sample(textures[static_cast<std::size_t>(material.texture)], at);
  const float share = second_share(material, at);
  return material.albedo + share * (material.second_albedo - material.albedo);
}

}  // namespace cgsr::sim
