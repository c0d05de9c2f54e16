#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tools/lab/box_tracker.h"

namespace cgsr::lab {

/// What a light estimate is beside the truth of the same image, both relative to image 0.
struct LightPair {
  Light truth;
  Light estimate;
};

/// How well lights were estimated.
struct LightScore {
  double error = 0.0;  ///< mean absolute, over channels and images.
  double chroma_correlation =
      0.0;  ///< Pearson's, of r/(r+g+b) and g/(r+g+b) together, each about its own mean; 0 where the truth is constant.
  int images = 0;
};

LightScore score_lights(std::span<const LightPair> pairs);

/// Pairs what a tracker said of the light with what was true, wherever it said something and the object is visible. Image 0 is left out.
///
/// \param estimates  absolute, one per image; entry 0 is the light assumed at learning, by which all are divided.
/// \param truth  relative to image 0.
std::vector<LightPair> light_pairs(std::span<const std::optional<Light>> estimates,
                                   std::span<const std::optional<Light>> truth);

}  // namespace cgsr::lab
