#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/board.h"

namespace cgsr::stages {

/// Which pixels of a camera show the robot's own board and probes, as they are configured: one byte each, not 0 where they do, row by row.
/// Ours; board and probes stand in the camera's view (5.1) and are no part of the scene.
///
/// \param camera  of the wanted size.  \param X_RC  its mount.
/// \param margin_px  by which all outlines grow: they are edges themselves, and calibration errs.
std::vector<std::uint8_t> self_mask(const illumination::Board& board, const geometry::Camera& camera,
                                    const geometry::Pose& X_RC, double margin_px);

}  // namespace cgsr::stages
