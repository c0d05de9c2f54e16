#pragma once

#include <optional>

#include <Eigen/Core>

#include "pipeline/illumination/luma_view.h"

namespace cgsr::illumination {

/// The shadow of an upright rod, a pencil say, on a bright plane: the dark strip that begins at its base.
/// Ours: a probe without silhouette lines, for photographs of other set-ups; its tip's shadow gives the ray of Eq. 5.1.
///
/// Every direction from the base is followed as long as it is dark against both sides; the longest one wins, and the edge where it ends, to a
/// fraction of a pixel, is the tip's shadow. What lies towards `top_px` is the rod itself.
///
/// \param base_px  where the rod stands. \param top_px  where its upper end is seen.
/// \return nothing: no direction is dark for ten times the width of a pixel or more.
std::optional<Eigen::Vector2d> find_rod_shadow(const LumaView& image, const Eigen::Vector2d& base_px,
                                               const Eigen::Vector2d& top_px);

}  // namespace cgsr::illumination
