#pragma once

#include <optional>

#include "src/sinks/fan_out.h"
#include "src/tasks/links.h"

namespace cgsr::tasks {

/// Brings what lies in the rings to the sinks, in the order of the images. Never real-time; what it cannot keep up with is lost and counted.
class HousekeepingTask {
 public:
  HousekeepingTask(Links& links, sinks::FanOut& sinks) : links_(links), sinks_(sinks) {}

  /// Deals with all that lies in the rings. \param now  on the time line of the stamps.
  void step(MonoTime now);

 private:
  void take(const sinks::VisionReport& report, MonoTime now);
  [[nodiscard]] std::optional<sinks::Picture> picture_of(std::uint64_t sequence);

  Links& links_;
  sinks::FanOut& sinks_;
  MotionStatus motion_;
  std::optional<sinks::Picture> next_picture_;
};

}  // namespace cgsr::tasks
