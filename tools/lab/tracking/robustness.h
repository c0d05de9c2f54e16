#pragma once

#include <vector>

#include <opencv2/core/types.hpp>

#include "tools/lab/scoring.h"
#include "tools/lab/tracking/runs.h"

namespace cgsr::lab {

// The starts of the object tracking benchmark's robustness evaluations (Wu, Lim and Yang, CVPR 2013, section 4).

/// Spatial robustness: the first box shifted by 10 % of its sides (four ways along the axes, four along the diagonals) and scaled around its
/// centre by .8, .9, 1.1 and 1.2. Twelve starts; a box is cut at the image.
std::vector<RunStart> spatial_starts(const Box& first, const cv::Size& image);

/// Temporal robustness: true boxes at `count` images spread evenly over the video, image 0 the first of them. Where the object is not
/// visible, the next image in which it is; each image once; none with fewer than ten images left.
std::vector<RunStart> temporal_starts(const Boxes& truth, int count);

/// Ours: the first box moved by half a pixel, to the left, right, top and bottom.
std::vector<RunStart> half_pixel_starts(const Box& first);

}  // namespace cgsr::lab
