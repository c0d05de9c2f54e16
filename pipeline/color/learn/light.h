#pragma once

#include <vector>

#include "pipeline/imaging/color_code.h"
#include "platform/parameters.h"

namespace cgsr::color {

/// The colour of a global light: what it multiplies each channel by (diagonal model, Eq. 3.1). 1 is the brightest that is simulated.
using Light = imaging::Rgb;

/// The lights that learning simulates: a grid of steps^3 over [min_level, max_level], without the implausible ones.
struct LightParameters {
  int steps = 3;
  double min_level = 0.6;
  double max_level = 1.0;
  double max_green_excess = 1.0;
  double assumed = 0.8;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("steps", self.steps, Range{1, 5}, "", "The number of simulated light levels per channel.");
    visit.number("min_level", self.min_level, Range{0.05, 1.0}, "",
                 "The darkest simulated light; below 0.4 the number of false positives grows.");
    visit.number("max_level", self.max_level, Range{0.05, 1.0}, "", "The brightest simulated light.");
    visit.number("max_green_excess", self.max_green_excess, Range{0.0, 1.0}, "",
                 "A light whose green exceeds the mean of its red and blue by more than this is implausible; 1 accepts "
                 "every light.");
    visit.number("assumed", self.assumed, Range{0.05, 1.0}, "",
                 "The light that is assumed while learning, unless a channel of the object is brighter.");
  }
};

/// The diagonal model (Eq. 3.1): recorded = texture * light, channel by channel.
constexpr imaging::Rgb lit(const imaging::Rgb& texture, const Light& light) {
  return {texture.r * light.r, texture.g * light.g, texture.b * light.b};
}

/// Its inverse: the texture that a recorded colour must have had. \param light  every channel > 0.
constexpr imaging::Rgb without_light(const imaging::Rgb& recorded, const Light& light) {
  return {recorded.r / light.r, recorded.g / light.g, recorded.b / light.b};
}

/// \return whether such a light is to be expected where the robot lives.
bool is_plausible(const Light& light, const LightParameters& parameters);

/// \return the plausible lights of the grid in the order r, g, b (b fastest); with one step the middle of the range.
///         Empty when the predicate leaves none or min_level > max_level.
std::vector<Light> light_grid(const LightParameters& parameters);

}  // namespace cgsr::color
