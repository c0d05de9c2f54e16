#pragma once

#include "hal/camera.h"
#include "src/tasks/links.h"

namespace cgsr::tasks {

/// Takes images from the camera and hands them on.
class CaptureTask {
 public:
  /// \param camera  started. \param period  of the camera.
  CaptureTask(hal::Camera& camera, Duration period, Links& links) : camera_(camera), period_(period), links_(links) {}

  /// Waits for one image, never past `give_up_at`. \return false when no further image will ever come.
  bool step(MonoTime give_up_at);

  [[nodiscard]] Duration period() const { return period_; }

 private:
  hal::Camera& camera_;
  Duration period_;
  Links& links_;
};

}  // namespace cgsr::tasks
