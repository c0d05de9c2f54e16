#pragma once

#include "pipeline/stages/frame_result.h"

namespace cgsr::stages {

/// What the robot does about what it sees: one of several tasks (follow an object, drive a route, Algorithm 5.2).
///
/// Threads: one, the vision thread. decide allocates nothing.
class Task {
 public:
  virtual ~Task() = default;

  /// \return what the first image is to be looked at for, before anything was decided.
  [[nodiscard]] virtual Requests first_requests() const { return {}; }

  /// \param frame  of this image: everything but its decision.
  /// \param elapsed  since the last image.
  virtual Decision decide(const FrameResult& frame, const ImageView& image, Duration elapsed) = 0;
};

}  // namespace cgsr::stages
