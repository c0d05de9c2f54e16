#include "hal/sim/generator/palette.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace cgsr::sim {
namespace {

// Encoded as sRGB, like those of the shipped worlds.
constexpr std::array<std::array<Triple, 2>, 6> kWoods{{{{{0.72, 0.56, 0.40}, {0.50, 0.35, 0.22}}},
                                                       {{{0.80, 0.63, 0.44}, {0.66, 0.48, 0.31}}},
                                                       {{{0.44, 0.29, 0.20}, {0.30, 0.19, 0.13}}},
                                                       {{{0.84, 0.74, 0.58}, {0.74, 0.62, 0.45}}},
                                                       {{{0.58, 0.50, 0.43}, {0.47, 0.40, 0.34}}},
                                                       {{{0.34, 0.25, 0.21}, {0.25, 0.18, 0.15}}}}};
constexpr std::array<Triple, 8> kCloths{{{0.47, 0.48, 0.50},
                                         {0.16, 0.36, 0.40},
                                         {0.62, 0.55, 0.46},
                                         {0.35, 0.20, 0.22},
                                         {0.25, 0.28, 0.36},
                                         {0.70, 0.66, 0.58},
                                         {0.40, 0.44, 0.32},
                                         {0.66, 0.40, 0.26}}};
constexpr std::array<Triple, 7> kPaints{{{0.72, 0.13, 0.11},
                                         {0.90, 0.75, 0.10},
                                         {0.12, 0.25, 0.62},
                                         {0.16, 0.45, 0.28},
                                         {0.86, 0.45, 0.12},
                                         {0.42, 0.24, 0.50},
                                         {0.20, 0.55, 0.60}}};
constexpr std::array<Triple, 6> kWalls{{{0.88, 0.86, 0.81},
                                        {0.90, 0.90, 0.89},
                                        {0.84, 0.82, 0.74},
                                        {0.78, 0.82, 0.82},
                                        {0.86, 0.80, 0.74},
                                        {0.80, 0.81, 0.78}}};
constexpr std::array<Triple, 5> kAccents{
    {{0.60, 0.68, 0.70}, {0.66, 0.56, 0.48}, {0.52, 0.60, 0.50}, {0.55, 0.52, 0.62}, {0.72, 0.62, 0.42}}};

Triple darker(const Triple& color, double factor) {
  return {rounded(color[0] * factor), rounded(color[1] * factor), rounded(color[2] * factor)};
}

}  // namespace

std::string Palette::add(MaterialSpec material) {
  const auto alike = std::count_if(materials_->begin(), materials_->end(),
                                   [&](const MaterialSpec& other) { return other.name.rfind(material.name, 0) == 0; });
  if (alike > 0) material.name += fmt::format(" {}", alike + 1);
  materials_->push_back(material);
  return material.name;
}

std::string Palette::once(std::string& kept, MaterialSpec material) {
  if (kept.empty()) kept = add(std::move(material));
  return kept;
}

Triple Palette::tinted(const Triple& srgb, double spread) {
  Triple color{};
  const double brightness = draw_.uniform(-spread, spread);
  for (std::size_t i = 0; i < 3; ++i) {
    color[i] = rounded(std::clamp(srgb[i] + brightness + draw_.uniform(-spread / 2.0, spread / 2.0), 0.03, 0.94));
  }
  return color;
}

std::string Palette::wood() {
  if (woods_.size() < 3) {
    MaterialSpec material;
    if (draw_.chance(0.25)) {
      material.name = "lacquer";
      material.albedo = tinted(draw_.chance(0.5) ? Triple{0.88, 0.88, 0.86} : Triple{0.20, 0.21, 0.23}, 0.04);
    } else {
      const auto& tones = draw_.pick(kWoods);
      material.name = "wood";
      material.pattern = PatternKind::kWood;
      material.albedo = tinted(tones[0], 0.04);
      material.second = darker(material.albedo, draw_.uniform(0.68, 0.86));
      material.size_m = draw_.uniform(0.25, 0.5);
    }
    material.specular = 0.04;
    material.roughness = draw_.uniform(0.35, 0.6);
    woods_.push_back(add(material));
    return woods_.back();
  }
  return woods_[static_cast<std::size_t>(draw_.below(static_cast<int>(woods_.size())))];
}

std::string Palette::cloth() {
  MaterialSpec material;
  material.name = "cloth";
  material.pattern = PatternKind::kFabric;
  material.albedo = tinted(draw_.pick(kCloths), 0.07);
  material.second = darker(material.albedo, draw_.uniform(0.72, 0.92));
  material.size_m = draw_.uniform(0.008, 0.03);
  return add(material);
}

std::string Palette::paint() {
  MaterialSpec material;
  material.name = "paint";
  material.albedo = tinted(draw_.pick(kPaints), 0.08);
  material.specular = draw_.chance(0.5) ? 0.03 : 0.0;
  material.roughness = 0.5;
  return add(material);
}

std::string Palette::metal() {
  MaterialSpec material;
  material.name = "metal";
  material.albedo = tinted(draw_.chance(0.5) ? Triple{0.62, 0.63, 0.64} : Triple{0.22, 0.22, 0.23}, 0.04);
  material.specular = 0.07;
  material.roughness = draw_.uniform(0.25, 0.45);
  return add(material);
}

std::string Palette::white() {
  MaterialSpec material;
  material.name = "white paint";
  material.albedo = tinted({0.90, 0.90, 0.88}, 0.03);
  material.specular = 0.04;
  material.roughness = 0.4;
  return once(white_, material);
}

std::string Palette::books() {
  MaterialSpec material;
  material.name = "books";
  material.pattern = PatternKind::kStripes;
  material.albedo = tinted(draw_.pick(kPaints), 0.1);
  material.second = tinted(draw_.pick(kCloths), 0.08);
  material.size_m = draw_.uniform(0.04, 0.09);
  material.width = draw_.uniform(0.35, 0.65);
  return add(material);
}

std::string Palette::screen() {
  MaterialSpec material;
  material.name = "screen";
  material.albedo = {0.06, 0.06, 0.07};
  material.specular = 0.05;
  material.roughness = 0.15;
  return once(screen_, material);
}

std::string Palette::leaf() {
  MaterialSpec material;
  material.name = "leaf";
  material.albedo = tinted({0.22, 0.40, 0.18}, 0.05);
  material.specular = 0.03;
  material.roughness = 0.5;
  return once(leaf_, material);
}

std::string Palette::pot() {
  MaterialSpec material;
  material.name = "pot";
  material.albedo = tinted(draw_.chance(0.5) ? Triple{0.66, 0.38, 0.27} : Triple{0.80, 0.79, 0.76}, 0.06);
  return add(material);
}

std::string Palette::artwork() {
  MaterialSpec material;
  material.name = "artwork";
  constexpr std::array kPatterns{PatternKind::kPrint, PatternKind::kFabric, PatternKind::kStripes,
                                 PatternKind::kChecker, PatternKind::kPlain};
  material.pattern = draw_.pick(kPatterns);
  material.albedo = tinted(draw_.chance(0.5) ? draw_.pick(kPaints) : Triple{0.90, 0.87, 0.78}, 0.08);
  material.second = tinted(draw_.chance(0.5) ? draw_.pick(kCloths) : Triple{0.16, 0.17, 0.22}, 0.08);
  material.size_m = material.pattern == PatternKind::kPrint ? draw_.uniform(0.02, 0.05) : draw_.uniform(0.08, 0.3);
  material.width = 0.5;
  return add(material);
}

std::string Palette::floor(bool tiled) {
  MaterialSpec material;
  material.name = "floor";
  material.roughness = draw_.uniform(0.35, 0.7);
  material.specular = 0.03;
  if (tiled) {
    material.pattern = PatternKind::kTape;
    material.albedo = tinted(draw_.chance(0.6) ? Triple{0.78, 0.77, 0.74} : Triple{0.50, 0.48, 0.46}, 0.06);
    material.second = darker(material.albedo, draw_.uniform(0.65, 0.85));
    material.size_m = draw_.uniform(0.2, 0.6);
    material.width = draw_.uniform(0.004, 0.009);
  } else if (draw_.chance(0.25)) {
    material.pattern = PatternKind::kFabric;
    material.albedo = tinted(draw_.pick(kCloths), 0.06);
    material.second = darker(material.albedo, draw_.uniform(0.8, 0.95));
    material.size_m = draw_.uniform(0.01, 0.04);
    material.specular = 0.0;
    material.roughness = 1.0;
  } else {
    const auto& tones = draw_.pick(kWoods);
    material.pattern = PatternKind::kWood;
    material.albedo = tinted(tones[0], 0.04);
    material.second = darker(material.albedo, draw_.uniform(0.6, 0.85));
    material.size_m = draw_.uniform(0.09, 0.22);
  }
  return add(material);
}

std::string Palette::wall() {
  MaterialSpec material;
  material.name = "wall";
  if (wall_.empty() || draw_.chance(0.72)) {
    material.albedo = tinted(draw_.pick(kWalls), 0.03);
    return once(wall_, material);
  }
  material.name = "accent wall";
  material.albedo = tinted(draw_.pick(kAccents), 0.05);
  if (draw_.chance(0.35)) {
    material.name = "wallpaper";
    material.pattern = draw_.chance(0.6) ? PatternKind::kStripes : PatternKind::kFabric;
    material.second = darker(material.albedo, draw_.uniform(0.82, 0.94));
    material.size_m = draw_.uniform(0.08, 0.25);
    material.width = 0.5;
  }
  return add(material);
}

std::string Palette::skirting() {
  MaterialSpec material;
  material.name = "skirting";
  material.albedo = tinted(draw_.chance(0.6) ? Triple{0.86, 0.85, 0.83} : Triple{0.50, 0.38, 0.27}, 0.04);
  return once(skirting_, material);
}

std::string Palette::ceiling() {
  MaterialSpec material;
  material.name = "ceiling";
  material.albedo = tinted({0.92, 0.92, 0.91}, 0.02);
  return once(ceiling_, material);
}

std::string Palette::curtain() {
  MaterialSpec material;
  material.name = "curtain";
  material.pattern = draw_.chance(0.6) ? PatternKind::kStripes : PatternKind::kFabric;
  material.albedo = tinted(draw_.chance(0.5) ? Triple{0.80, 0.76, 0.66} : draw_.pick(kCloths), 0.06);
  material.second = darker(material.albedo, draw_.uniform(0.78, 0.94));
  material.size_m = draw_.uniform(0.05, 0.12);
  return add(material);
}

std::string Palette::rug() {
  MaterialSpec material;
  material.name = "rug";
  material.pattern = draw_.chance(0.6) ? PatternKind::kFabric : PatternKind::kChecker;
  material.albedo = tinted(draw_.pick(kCloths), 0.1);
  material.second = darker(material.albedo, draw_.uniform(0.6, 0.9));
  material.size_m = material.pattern == PatternKind::kFabric ? draw_.uniform(0.02, 0.05) : draw_.uniform(0.15, 0.35);
  return add(material);
}

std::string Palette::sky() {
  MaterialSpec material;
  material.name = "sky";
  material.albedo = {0.3, 0.3, 0.3};
  return add(material);
}

}  // namespace cgsr::sim
