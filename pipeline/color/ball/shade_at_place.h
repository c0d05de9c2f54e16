#pragma once

#include "pipeline/color/ball/ball_circle.h"

namespace cgsr::color {

/// What map, lamp and pose say of a place (5.2), where a mask speaks of whole rays: some point of a ray may be shaded long before the ball, or
/// behind it. Ours: the dissertation's mask is all that its tracker knows.
class ShadeAtPlace {
 public:
  ShadeAtPlace() = default;
  ShadeAtPlace(const ShadeAtPlace&) = delete;
  ShadeAtPlace& operator=(const ShadeAtPlace&) = delete;
  virtual ~ShadeAtPlace() = default;

  /// \param circle  a ball's in the image.
  /// \return whether some of a ball of that diameter may lie in shade where it shows this circle.
  [[nodiscard]] virtual bool may_be_shaded(const Circle& circle, double diameter_m) const = 0;

  /// \return whether all of it lies in shade there.
  [[nodiscard]] virtual bool is_shaded(const Circle& circle, double diameter_m) const = 0;
};

}  // namespace cgsr::color
