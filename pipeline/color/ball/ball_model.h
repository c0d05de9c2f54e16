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
  /// What a colour code can be, in of_code.
  static constexpr std::uint8_t kBright = 1;
  static constexpr std::uint8_t kDark = 2;

  ColorModel bright;  ///< histograms under the lights of the model.
  ColorModel
      dark;  ///< the same lights, multiplied by every darkness factor: light i is bright light i % bright.lights.size().

  /// For every light of the grid, of every colour code: kBright, kDark or both when the ball shows such a colour under a light that is nearer to
  /// this one than to its neighbours, bright or darkened by anything from the least factor up to nearly nothing (the border of a shadow is soft),
  /// give or take a step of the code for the camera's noise.
  std::vector<std::vector<std::uint8_t>> of_code;

  double diameter_px = 0.0;  ///< learned.
};

/// \param factors  of darkness, each in (0, 1]; those that leave more than kMaxLights lights are refused.
/// \return an error in words: a defective model, one that keeps no sample, factors out of range.
Result<BallModel> make_ball_model(const ColorModel& model, std::span<const double> factors);

}  // namespace cgsr::color
