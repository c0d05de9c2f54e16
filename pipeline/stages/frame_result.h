#pragma once

#include "pipeline/runtime/aged.h"
#include "pipeline/stages/decision.h"
#include "pipeline/stages/decode_stage.h"
#include "pipeline/stages/localize_stage.h"
#include "pipeline/stages/probes_stage.h"
#include "pipeline/stages/search_stage.h"
#include "pipeline/stages/shade_stage.h"
#include "pipeline/stages/track_stage.h"

namespace cgsr::stages {

/// What is known beside the image when it comes.
struct FrameInputs {
  std::optional<hal::Odometry> odometry;  ///< of the base, at the image's exposure.
  LampLines lamps{};                      ///< the switched lamps' lines as this image shows them.
  Requests requests;                      ///< of the decision about the last image.
};

/// What one image led to: the last output of every stage (the components of Fig. 5.1), with its age.
struct FrameResult {
  runtime::Aged<View> view;
  runtime::Aged<PoseEstimate> pose;
  runtime::Aged<LampReport> lamp;
  runtime::Aged<ShadowMasks> shade;
  runtime::Aged<color::SearchResult> matches;
  runtime::Aged<TrackedObjects> objects;
  runtime::Aged<Decision> decision;
};

}  // namespace cgsr::stages
