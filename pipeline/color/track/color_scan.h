#pragma once

#include <array>
#include <span>
#include <vector>

#include "pipeline/color/track/color_likelihood.h"
#include "pipeline/imaging/pyramid.h"
#include "platform/box.h"

namespace cgsr::color {

/// Looks over the whole image for places whose pixels are likelier to be the object's, by its recent colours, than those around them: where
/// something that was lost may have come back. Coarse: samples of an eighth of the object's smaller side, at least a 160th of the image's larger
/// one; three sizes. (The difference of the likelihood inside and around as in Possegger et al. 2015, who find distractors so.)
///
/// Threads: one. Memory is reserved at construction.
class ColorScan {
 public:
  static constexpr std::size_t kMaxPlaces = 9;

  ColorScan();

  /// \param colors  of object and surroundings, under the light of the learned image. \param light  gain of the present image's from that one.
  /// \param object  whose size is looked for. \return places of which no two overlap by much, the one that stands out most first; valid until
  ///         the next call.
  std::span<const Box> places(const imaging::Pyramid& image, const ColorLikelihood& colors, const Light& light,
                              const Box& object);

 private:
  struct Window {
    float separation;  ///< of the likelihoods inside and around, -1..1.
    Box box;
  };
  static constexpr Window kNone{0.0F, {}};
  void sum_likelihoods(const imaging::Pyramid& image, const ColorLikelihood& colors, const Light& light);
  void weigh_windows(double width, double height);
  [[nodiscard]] float sum(int left, int top, int right, int bottom) const;

  ColorPatch patch_;
  double step_x_px_ = 1.0;  ///< camera pixels from one sample to the next.
  double step_y_px_ = 1.0;
  std::vector<float> integral_;
  std::vector<Window> windows_;
  std::array<Box, kMaxPlaces> places_;
};

}  // namespace cgsr::color
