#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/color/learn/color_model.h"
#include "platform/error.h"

namespace cgsr::color {

/// What a learned ball looks like in the light and in the shade (5.3), out of the samples that its model keeps: only the circle in the
/// box that was asked for counts, not its corners.
struct BallModel {
  /// What a colour code can be, in of_code: a colour of the ball in the light, or in shade of one of kDepths depths.
  static constexpr std::uint8_t kBright = 1;
  static constexpr int kDepths = 3;
  static constexpr std::uint8_t kDeepest = 2;  ///< the next depth's bit is the next higher one.
  static constexpr std::uint8_t kAny = 15;

  ColorModel bright;  ///< histograms under the lights of the model.
  ColorModel
      dark;  ///< the same lights, multiplied by every darkness factor: light i is bright light i % bright.lights.size().

  /// For every light of the grid, of every colour code: what it can be when the ball shows such a colour under a light that is nearer to
  /// this one than to its neighbours, bright or darkened by anything from the least factor up to nearly nothing (the border of a shadow is soft),
  /// give or take a step of the code for the camera's noise. How dark matters: an orange ball in the deepest shade looks like a brown floor.
  std::vector<std::vector<std::uint8_t>> of_code;

  /// Of every factor the kind of its colours; where there are more than kDepths, neighbours share one.
  std::vector<std::uint8_t> dark_kinds;

  double diameter_px = 0.0;  ///< learned.

  /// \param light  of `dark`.
  [[nodiscard]] std::uint8_t kind_of_dark(std::size_t light) const {
    return dark_kinds[light / bright.lights.size() % dark_kinds.size()];
  }
};

/// \param factors  of darkness, each in (0, 1]; those that leave more than kMaxLights lights are refused.
/// \return an error in words: a defective model, one that keeps no sample, factors out of range.
Result<BallModel> make_ball_model(const ColorModel& model, std::span<const double> factors);

}  // namespace cgsr::color
