#pragma once

#include "pipeline/color/ball/integrated_tracker.h"
#include "pipeline/runtime/aged.h"
#include "pipeline/stages/shade_stage.h"
#include "pipeline/stages/tracked_objects.h"
#include "platform/work_budget.h"

namespace cgsr::stages {

inline constexpr Duration kMaxMaskAge = seconds(0.5);    ///< of the shadow masks that are used.
inline constexpr Duration kMaxPlacesAge = seconds(0.1);  ///< of the pose with which single places are asked for.

/// The track stage's work where the object is a ball (5.3): the masks' cells say where dark histograms are searched, the map whether the ball's own
/// place may lie in shade.
/// \param shade  of this image or an older one, whose masks are used as long as kMaxMaskAge allows.
ObjectTrack track_ball(color::IntegratedTracker& tracker, const ImageView& image,
                       const runtime::Aged<ShadowMasks>& shade, WorkBudget& budget);

}  // namespace cgsr::stages
