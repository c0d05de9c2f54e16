#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "platform/parameters.h"

namespace cgsr::sim {

/// Linear R, G, B.
using Rgb = Eigen::Vector3f;

/// A colour as people write it (sRGB-encoded, 0..1) in linear light.
Rgb from_srgb(const std::array<double, 3>& encoded);

/// What is drawn on a surface. Every pattern is a mix of the material's two albedos; sizes are metres on the surface.
enum class PatternKind : std::uint8_t {
  kPlain,    ///< the first albedo everywhere.
  kChecker,  ///< squares of side `size_m`; the one right and above the origin of the surface is of the first albedo.
  kStripes,  ///< bands across u, one period each `size_m`; the share `width` of it is of the second albedo.
  kTape,     ///< a grid of lines: spacing `size_m`, line width `width_m`, of the second albedo.
  kPrint,    ///< lines of letter-like marks of height `size_m` with margins: paper, posters.
  kWood,     ///< planks of width `size_m` along u, with grain.
  kFabric,   ///< fine irregular weave: carpets and cloth. `size_m` is the size of a blotch.
};

inline constexpr Named<PatternKind> kPatternNames[] = {
    {"plain", PatternKind::kPlain},   {"checker", PatternKind::kChecker}, {"stripes", PatternKind::kStripes},
    {"tape", PatternKind::kTape},     {"print", PatternKind::kPrint},     {"wood", PatternKind::kWood},
    {"fabric", PatternKind::kFabric},
};
constexpr std::string_view to_string(PatternKind kind) {
  return word_in(kPatternNames, kind);
}

/// A square-pixel image with its mip levels, linear light, four channels of which three are used. u to the right, v down, both wrap.
struct Texture {
  struct Level {
    int width_px = 0;
    int height_px = 0;
    std::vector<float> rgb;  ///< three per texel, row by row.
  };
  std::vector<Level> levels;  ///< each half the one before, down to 1 texel on the shorter side.
};

/// Builds the mip levels above a base image whose sides are powers of two.
Texture make_texture(int width_px, int height_px, std::vector<float> rgb);

/// How a surface answers light: matt (Lambert) plus, where `specular` > 0, a gloss lobe (GGX) of the lamp's own colour.
struct Material {
  std::string name;
  Rgb albedo = Rgb::Constant(0.5F);  ///< linear, 0..1.
  Rgb second_albedo = Rgb::Zero();   ///< the pattern's other colour.
  PatternKind pattern = PatternKind::kPlain;
  float size_m = 0.1F;
  float width = 0.5F;                ///< stripes: share of the period; tape: line width [m].
  float roughness = 1.0F;            ///< 0.05 (polished) .. 1.
  float specular = 0.0F;             ///< reflectance at normal incidence: 0 matt, 0.04 varnish.
  Rgb emission_cd_m2 = Rgb::Zero();  ///< glows by itself; lights nothing else (lamps do).
  int texture = -1;                  ///< index into the scene's textures; replaces `albedo`.
};

}  // namespace cgsr::sim
