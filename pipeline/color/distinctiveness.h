#pragma once

#include <span>

#include "pipeline/imaging/color_code.h"

namespace cgsr::color {

/// How far a region is from being of a single hue (the multi-colour constraint, 3.1.2).
struct Distinctiveness {
  double divergence =
      0.0;  ///< Jensen-Shannon divergence [nat] to the nearest single-hued surface under any light, 0..ln 2.
  double largest_hue = 1.0;  ///< m: the share of the region that one hue explains.
};

/// Under the diagonal model a light moves every pixel's (ln R/G, ln B/G) by the same vector, so what the region looks like in that plane
/// does not depend on the light, and a surface of one hue, however shaded, is a point of it. m is the largest share of pixels within
/// one square of half side 0.25 (29 % of a ratio: sensor noise, chroma subsampling, highlights). Dark pixels (all channels
/// below 0.12) have no hue: they are counted to every hue. The single-hued surface that is hardest to tell from the region has exactly
/// the region's colours within that square, and its divergence from the region is
///
///   D(m) = 1/2 [ ln 2/(1+m) + m ln 2m/(1+m) + (1-m) ln 2 ].
///
/// A search that accepts divergences above D takes every plain surface of the right shading for the object under some light.
/// \param textures  the region's colours, light taken out; none: m = 1.
Distinctiveness distinctiveness_of(std::span<const imaging::Rgb> textures);

}  // namespace cgsr::color
