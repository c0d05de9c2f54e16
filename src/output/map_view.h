#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/render/expectation.h"
#include "pipeline/world/index.h"
#include "pipeline/world/map.h"

namespace cgsr::app {

/// \return the map as a camera sees it, through its lens: each surface in its material's colour, a little darker where it is steep. B G R.
cv::Mat draw_surfaces(const world::Map& map, const world::Index& index, const geometry::Pose& X_WC,
                      const geometry::Camera& camera);

/// Draws visible pieces of edges over a picture of the camera's size, bent as its lens does. Crease, border, material and drawn edges each have
/// a colour of their own.
void draw_pieces(const world::Map& map, std::span<const render::VisiblePiece> pieces, const geometry::Camera& camera,
                 cv::Mat& picture);

}  // namespace cgsr::app
