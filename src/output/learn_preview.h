#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "pipeline/color/learn/learn.h"

namespace cgsr::app {

/// Draws what was learned (Fig. 3.2): each sample with the asked box and the learned window, the learned texture under every light
/// of the model, and below them how distinctive it is, in learning's own words.
/// \param samples  as they were given to learn().
cv::Mat draw_preview(std::span<const color::Sample> samples, const color::Learned& learned);

}  // namespace cgsr::app
