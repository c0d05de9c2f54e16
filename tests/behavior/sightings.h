#pragma once

#include <cmath>

#include "pipeline/behavior/follow.h"

namespace cgsr::behavior {

inline constexpr Duration kImagePeriod = std::chrono::microseconds(33333);

/// The webcam of the robot, nothing found.
inline Sighting nothing() {
  Sighting sighting;
  sighting.image_width_px = 640;
  sighting.image_height_px = 480;
  sighting.fx_px = 601.8;
  sighting.cx_px = 319.5;
  return sighting;
}

/// A box found, its centre in the given column.
inline Sighting seen(double centre_px, double width_px = 60.0, double height_px = 120.0, double top_px = 180.0) {
  Sighting sighting = nothing();
  sighting.found = true;
  sighting.box = {centre_px - 0.5 * width_px, top_px, width_px, height_px};
  return sighting;
}

/// The same sighting, image after image.
inline FollowDecision repeat(Follow& follow, const Sighting& sighting, int images) {
  FollowDecision decision;
  for (int i = 0; i < images; ++i) decision = follow.decide(sighting, kImagePeriod);
  return decision;
}

}  // namespace cgsr::behavior
