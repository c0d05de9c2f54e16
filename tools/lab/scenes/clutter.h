#pragma once

#include <vector>

#include "tools/lab/scenes/canvas.h"

namespace cgsr::lab {

/// A hue counts as one of the object's when it is this near to it, in turns.
inline constexpr double kSameHue = 12.0 / 360.0;
/// Below this saturation a pixel has no hue to speak of.
inline constexpr double kGreySaturation = 0.12;

/// A cluttered background: a few hundred grained leaves of all sizes, some striped, lie over each other. Leaves that make up `shared` of the
/// pixels have the hues of `palette` (half of these its very colours), the others greys and hues well away from it.
Canvas random_clutter(int width_px, int height_px, const std::vector<Rgb>& palette, double shared, Random random);

/// \return the share of pixels that have a hue within kSameHue of one in `palette`.
double share_of_hues(const Canvas& canvas, const std::vector<Rgb>& palette);

}  // namespace cgsr::lab
