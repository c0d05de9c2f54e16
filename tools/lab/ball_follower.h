#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "pipeline/color/ball/integrated_tracker.h"
#include "platform/box.h"
#include "platform/error.h"
#include "src/config/color.h"
#include "tools/lab/image.h"
#include "tools/lab/shade_trial.h"

namespace cgsr::lab {

/// The stage track with a ball that is learned from one box of one image.
/// \param row  the stage's in the robot's schedule.  \param focal_px  mean of fx and fy.
Result<BallTracker> learned_ball(const Image& image, const Box& box, const config::Color& configuration,
                                 const color::IntegratedParameters& parameters, const runtime::StageParameters& row,
                                 double focal_px);

/// Masks of the same size that say: nothing is shaded.
stages::ShadowMasks all_lit(const shade::ShadeMasks& masks);

/// What `cgsr-lab follow-ball` does, the program that is counted: follows the ball through FOLDER/img, learned from its first image and the
/// first box of FOLDER/groundtruth.txt, with FOLDER/mask.png over every image or without a mask. The tracker's work is marked as the
/// stage "ball".
/// \return how often it was found, or what is missing.
Result<int> follow_ball(const std::string& folder, bool with_mask, double focal_px, const config::Color& configuration);

}  // namespace cgsr::lab
