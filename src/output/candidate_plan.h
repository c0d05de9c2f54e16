#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "pipeline/global_localization/global_localizer.h"
#include "pipeline/world/map.h"

namespace cgsr::app {

/// \return the map's edges from above, x to the right and y up, and where in it the robot may be: an arrow for each candidate, with its likeness and
///         the images that corrected it; green where these were enough, orange where it was tried in vain, grey where it was not tried. B G R.
cv::Mat draw_candidates(const world::Map& map, std::span<const global_localization::Candidate> candidates);

}  // namespace cgsr::app
