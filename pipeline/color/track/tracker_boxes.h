#pragma once

#include <algorithm>

#include "pipeline/color/learn/color_model.h"
#include "platform/box.h"

// Boxes about the same centre, of another size: what the tracker moves and grows.
// Ours: the dissertation (3.2.2) names location and size in the previous image as a prior, and gives no limits.
namespace cgsr::color {

inline constexpr double kLargestGrowth = 1.25;  // from one image to the next

inline Box centred_on(const Box& place, double width, double height) {
  return {place.x + 0.5 * (place.width - width), place.y + 0.5 * (place.height - height), width, height};
}

/// A box about its centre, grown by a factor that is held within reason.
inline Box grown(const Box& box, double factor, const ColorModel& model, double limit) {
  if (factor == 1.0) return box;
  const double asked = std::clamp(factor, 1.0 / kLargestGrowth, kLargestGrowth);
  const double width = std::clamp(box.width * asked, model.width_px / limit, model.width_px * limit);
  return centred_on(box, width, box.height * width / box.width);
}

inline Box with_centre_inside(Box box, int width_px, int height_px) {
  box.x = std::clamp(box.x, -0.5 * box.width, width_px - 0.5 * box.width);
  box.y = std::clamp(box.y, -0.5 * box.height, height_px - 0.5 * box.height);
  return box;
}

}  // namespace cgsr::color
