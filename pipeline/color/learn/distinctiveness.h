#pragma once

#include <span>

#include "pipeline/imaging/color_code.h"

namespace cgsr::color {

/// How far a region is from being of a single colour (the multi-colour constraint, 3.1.2). The measure is ours: the
/// dissertation only requires several colours.
struct Distinctiveness {
  double divergence =
      0.0;  ///< Jensen-Shannon divergence [nat] to the nearest single-coloured surface under any light, 0..ln 2.
  double max_share = 1.0;  ///< m: the share of the region that one colour explains.
};

/// A surface of one colour c, shaded and seen by a noisy camera, shows the colours s c, s in [1/1.4, 1.4], give or take 0.07. Any such
/// surface is met in a room: under some light its colour is c. So the surface that is hardest to tell from the region has exactly the
/// region's colours near that line, a share m of them, and nothing else; its divergence from the region is
///
///   D(m) = 1/2 [ ln 2/(1+m) + m ln 2m/(1+m) + (1-m) ln 2 ],
///
/// least for the c that explains most. A search that accepts divergences above D takes plain surfaces for the object.
/// \param textures  the region's colours, light taken out; none: m = 1.
/// Cost: some million operations; learn time only.
Distinctiveness distinctiveness_of(std::span<const imaging::Rgb> textures);

}  // namespace cgsr::color
