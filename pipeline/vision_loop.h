#pragma once

#include "pipeline/runtime/stage.h"
#include "pipeline/stages/decide_stage.h"
#include "pipeline/stages/frame_result.h"
#include "pipeline/stages/stage_list.h"

namespace cgsr {

/// The stages of Figure 5.1, in the order of the schedule's rows.
using VisionStageList =
    stages::StageList<stages::DecodeStage, stages::LocalizeStage, stages::ProbesStage, stages::ShadeStage,
                      stages::SearchStage, stages::TrackStage, stages::IdentifyStage, stages::DecideStage>;

/// The section [stage] of a robot's file.
using VisionStages = VisionStageList::Rows;
/// What does the work of each stage; what a robot has not is missing.
using VisionParts = VisionStageList::Parts;

/// One image through Figure 5.1: every line of on_image is a stage with a row in the schedule.
///
/// Threads: one, the vision thread. After construction nothing here allocates.
class VisionLoop {
 public:
  /// \param runner  outlives the loop.
  VisionLoop(runtime::StageRunner& runner, VisionParts parts) : runner_(runner), stages_(parts.stages()) {}
  VisionLoop(const VisionLoop&) = delete;
  VisionLoop& operator=(const VisionLoop&) = delete;

  /// Gives every stage its row in the runner's schedule; to be called once, before the first image.
  Result<void> bind() {
    return std::apply([this](auto&... stage) { return runner_.bind(stage...); }, stages_);
  }

  /// Image in, result out; valid until the next image. Between the runner's begin_frame and end_frame.
  const stages::FrameResult& on_image(const ImageLease& image, const stages::FrameInputs& inputs);

  /// What the decision about the last image asks of the next one; before the first: what its task begins with.
  [[nodiscard]] stages::Requests requests();

 private:
  template <class Worker, class... Inputs>
  const auto& run(const Inputs&... inputs) {
    return runner_.run(std::get<runtime::Stage<Worker>>(stages_), inputs...);
  }

  /// \return a stage's worker; null where the robot has none.
  template <class Worker>
  [[nodiscard]] Worker* worker() {
    return std::get<runtime::Stage<Worker>>(stages_).worker();
  }

  runtime::StageRunner& runner_;
  VisionStageList::Stages stages_;
  stages::FrameResult frame_;
};

}  // namespace cgsr
