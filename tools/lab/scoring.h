#pragma once

#include "src/scoring/scoring.h"

namespace cgsr::lab {

// One scoring for the program and the lab.
using app::Boxes;
using app::ImageScore;
using app::read_track;
using app::read_truth;
using app::Score;
using app::score;
using app::score_image;
using app::score_images;

}  // namespace cgsr::lab
