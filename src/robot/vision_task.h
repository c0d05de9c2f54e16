#pragma once

#include "pipeline/runtime/images_in_time.h"
#include "pipeline/runtime/stage.h"
#include "pipeline/vision_loop.h"
#include "src/robot/links.h"

namespace cgsr::robot {

/// Runs the vision loop once per image and passes on what it decided.
class VisionTask {
 public:
  VisionTask(VisionLoop& loop, runtime::StageRunner& runner, const Clock& clock, Duration period, Links& links)
      : loop_(loop), runner_(runner), clock_(clock), links_(links), in_time_(period) {}

  /// Deals with the newest image. \return false when there was none.
  bool step();

  /// A frame without an image, because none came until `now`.
  void step_without_image(MonoTime now);

 private:
  void ask_for_switchings();
  void report(const Decision& decision, ImageLease image);

  VisionLoop& loop_;
  runtime::StageRunner& runner_;
  const Clock& clock_;
  Links& links_;
  runtime::ImagesInTime in_time_;
};

}  // namespace cgsr::robot
