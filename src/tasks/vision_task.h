#pragma once

#include "pipeline/runtime/images_in_time.h"
#include "pipeline/stages/odometry_track.h"
#include "pipeline/stages/switchboard.h"
#include "pipeline/vision_loop.h"
#include "src/tasks/links.h"

namespace cgsr::tasks {

/// What the vision task keeps of the world beside the images.
struct VisionSurroundings {
  stages::OdometryTrack odometry;   ///< of the base.
  stages::Switchboard switchboard;  ///< the lamps that may be switched; by default none.
};

/// Runs the vision loop once per image: gathers what is known beside the image, and passes on what was decided.
class VisionTask {
 public:
  VisionTask(VisionLoop& loop, runtime::StageRunner& runner, const VisionSurroundings& surroundings, const Clock& clock,
             Duration period, Links& links)
      : loop_(loop), runner_(runner), surroundings_(surroundings), clock_(clock), links_(links), in_time_(period) {}

  /// Deals with the newest image. \return false when there was none.
  bool step();

  /// A frame without an image, because none came until `now`.
  void step_without_image(MonoTime now);

 private:
  [[nodiscard]] stages::FrameInputs inputs_at(MonoTime stamp);
  void request_switching(const stages::Requests& requests, MonoTime stamp);
  void report(const stages::FrameResult& result, ImageLease image);

  VisionLoop& loop_;
  runtime::StageRunner& runner_;
  VisionSurroundings surroundings_;
  const Clock& clock_;
  Links& links_;
  runtime::ImagesInTime in_time_;
};

}  // namespace cgsr::tasks
