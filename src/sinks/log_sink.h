#pragma once

#include <array>
#include <string>

#include "src/sinks/sink.h"

namespace cgsr::sinks {

/// Writes changes of state into the log: one line for each, with the image and the reason.
class LogSink final : public Sink {
 public:
  Result<void> on_image(const ImageReport& report) override;
  Result<void> on_missing_image(const runtime::FrameRecord& record) override;
  Result<void> on_control_cycle(const MotionStatus& status) override;
  Result<void> on_switching(const SwitchRecord& record) override;

 private:
  void log_task(const ImageReport& report);
  void log_pose(const ImageReport& report);
  void log_lamp(const ImageReport& report);
  void log_check(const ImageReport& report, illumination::CheckedLamp lamp, const illumination::CheckReport& check);

  std::string task_state_;
  localization::TrackState pose_ = localization::TrackState::kUnsure;
  bool probes_visible_ = true;
  bool lamp_known_ = false;
  stages::ShadeStatus shade_ = stages::ShadeStatus::kNoMap;
  std::array<illumination::CheckState, 2> checks_{};  // by CheckedLamp
  bool cycled_ = false;
  MotionStatus motion_;
};

}  // namespace cgsr::sinks
