#pragma once

#include "src/sinks/sink.h"

namespace cgsr::sinks {

/// Writes events, faults, stops of the motion and switched lamps into the log: one line for each, with the image and the reason.
class LogSink final : public Sink {
 public:
  Result<void> on_image(const ImageReport& report) override;
  Result<void> on_missing_image(const runtime::FrameRecord& record) override;
  Result<void> on_control_cycle(const MotionStatus& status) override;
  Result<void> on_switching(const SwitchRecord& record) override;

 private:
  bool cycled_ = false;
  MotionStatus motion_;
};

}  // namespace cgsr::sinks
