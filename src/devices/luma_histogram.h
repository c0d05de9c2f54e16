#pragma once

#include <array>
#include <cstdint>

#include "platform/image_view.h"

namespace cgsr::devices {

/// How bright the pixels of an image are: Y of BT.601, 16 black, 235 white.
struct LumaHistogram {
  static constexpr int kBlack = 24;       ///< up to here a pixel carries no colour.
  static constexpr int kSaturated = 233;  ///< from here on it is cut off.

  std::array<std::uint32_t, 256> counts{};
  std::uint32_t pixels = 0;

  [[nodiscard]] double black_share() const;
  [[nodiscard]] double saturated_share() const;
  /// \param share  of the pixels, 0..1. \return the least luma that at least so many pixels do not exceed.
  [[nodiscard]] int quantile(double share) const;
};

/// \param image  YUYV.
LumaHistogram luma_histogram(const ImageView& image);

/// One step of the search for an exposure under which the bright parts are bright and not cut off. Light is linear in the
/// exposure, luma is encoded:
///
///   e' = e (t / q)^2.2    q: the 98th percentile of luma above black, t: its target, both of 219; a factor of 1/4..4
///
/// \return the exposure to try next [s]; the same when q is near enough to its target.
double next_exposure_s(double exposure_s, const LumaHistogram& histogram);

}  // namespace cgsr::devices
