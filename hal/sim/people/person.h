#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/sim/scene/scene.h"
#include "platform/parameters.h"

namespace cgsr::sim {

/// How many people are made by hand: identity 0 .. kIdentities - 1.
inline constexpr int kIdentities = 8;
/// Those after them, up to this one, are drawn by their number.
inline constexpr int kLastIdentity = 99'999;

enum class ShirtKind : std::uint8_t { kPlain, kStriped, kTwoColoured };
inline constexpr Named<ShirtKind> kShirtNames[] = {
    {"plain", ShirtKind::kPlain}, {"striped", ShirtKind::kStriped}, {"two_coloured", ShirtKind::kTwoColoured}};
constexpr std::string_view to_string(ShirtKind kind) {
  return word_in(kShirtNames, kind);
}

/// What a person wears. Colours are linear.
struct Outfit {
  ShirtKind shirt = ShirtKind::kPlain;
  Rgb color{0.05F, 0.08F, 0.30F};
  Rgb second{0.8F, 0.8F, 0.8F};
  Rgb trousers{0.02F, 0.02F, 0.03F};
  int marker = -1;       ///< ArUco 4x4_50 on the chest; -1: none.
  int back_marker = -1;  ///< the same on the back.
};

/// A person to be added to a scene.
struct Person {
  std::string name = "person";
  int identity = 0;
  double height_m = 1.72;
  std::vector<Outfit> outfits;  ///< empty: the identity's own.
};

/// The outfit in which an identity comes when nothing else is said.
Outfit usual_outfit(int identity);

/// Adds the figure, its parts, materials and the face's texture. Path, head and presence scripts are the caller's to set.
/// \return the figure's index.
int add_person(Scene& scene, const Person& person);

}  // namespace cgsr::sim
