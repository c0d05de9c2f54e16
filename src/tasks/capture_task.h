#pragma once

#include "hal/camera.h"
#include "platform/clock.h"
#include "src/tasks/links.h"

namespace cgsr::tasks {

/// Takes images from the camera and hands them on.
class CaptureTask {
 public:
  /// \param camera  started. \param period  of the camera.
  CaptureTask(hal::Camera& camera, Duration period, Links& links) : camera_(camera), period_(period), links_(links) {}

  /// Waits for one image, never past `give_up_at`. \return false when no further image will ever come.
  bool step(MonoTime give_up_at);

  /// Of a camera that has streamed before anybody took its images: gives back what it holds, so that the first image that is handed on is a new one.
  /// Such images are neither counted nor seen by vision; at most 32 are given back. Not for a recording, which always holds the next one. Ours.
  /// \return how many were given back.
  int pass_over_waiting(const Clock& clock);

  [[nodiscard]] Duration period() const { return period_; }

 private:
  hal::Camera& camera_;
  Duration period_;
  Links& links_;
};

}  // namespace cgsr::tasks
