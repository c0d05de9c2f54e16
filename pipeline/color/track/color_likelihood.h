#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/color/learn/light.h"
#include "pipeline/color/track/relight.h"
#include "pipeline/imaging/pyramid.h"
#include "platform/box.h"

namespace cgsr::color {

/// Colours of a patch: three planes of size.area() values, row by row, as the camera coded them.
struct ColorPatch {
  imaging::PatchSize size;
  std::vector<std::uint8_t> y, u, v;

  explicit ColorPatch(imaging::PatchSize s) : size(s), y(s.area()), u(s.area()), v(s.area()) {}

  /// Allocates only where it was never as large.
  void resize(imaging::PatchSize s) {
    size = s;
    y.resize(s.area());
    u.resize(s.area());
    v.resize(s.area());
  }
};

/// relight() of all its pixels.
inline void relight(ColorPatch& patch, const Light& gain) {
  relight(patch.y, patch.u, patch.v, gain);
}

/// How likely a pixel belongs to the object, by its colour: the share of the object among object and surroundings in its histogram bin
/// (Bayes with equal priors, Possegger et al. 2015; positives and negatives as in section 6.2.2). 8 x 32 x 32 bins of Y, U, V.
class ColorLikelihood {
 public:
  ColorLikelihood();

  /// Counts the patch's colours in. \param inside  what is surely the object; \param outside  what lies beyond this box is surroundings
  /// (between the two nothing is counted), both in pixels of the patch. \param rate  share of the new counts; 1 forgets the old.
  void learn(const ColorPatch& patch, const Box& inside, const Box& outside, double rate);

  [[nodiscard]] float of(std::uint8_t y, std::uint8_t u, std::uint8_t v) const { return likelihood_[bin_of(y, u, v)]; }

 private:
  static constexpr std::size_t kBins = std::size_t{8} * 32 * 32;
  static std::size_t bin_of(std::uint8_t y, std::uint8_t u, std::uint8_t v) {
    return static_cast<std::size_t>((y >> 5) << 10 | (u >> 3) << 5 | v >> 3);
  }

  std::vector<float> object_, surroundings_, likelihood_;
  std::vector<float> counted_in_, counted_out_;
};

}  // namespace cgsr::color
