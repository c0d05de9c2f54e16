#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "pipeline/motion/motion_status.h"
#include "platform/error.h"
#include "src/sinks/records.h"

namespace cgsr::sinks {

/// One image as every sink gets it.
struct ImageReport {
  const stages::FrameResult& frame;
  const runtime::FrameRecord& record;
  const MotionStatus& motion;  ///< of the last control cycle before.
  const Picture* picture;      ///< null: it found no room on its way here.
  MonoTime taken_at{};         ///< when housekeeping took it out of its ring.
};

/// What a run came to.
struct Summary {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();  ///< for machines.
  std::string text;                                                ///< for people.
};

/// Somebody who reads what the robot says of itself: a file, the log, a picture, a statistic. Never real-time.
///
/// An error ends the sink: it gets nothing more, and the run ends with that problem. Threads: one, housekeeping.
class Sink {
 public:
  virtual ~Sink() = default;

  /// An image that went through the stages.
  virtual Result<void> on_image(const ImageReport& report) = 0;
  /// A frame for which no image came in time.
  virtual Result<void> on_missing_image(const runtime::FrameRecord& /*record*/) { return {}; }
  /// A cycle of the motion loop.
  virtual Result<void> on_control_cycle(const MotionStatus& /*status*/) { return {}; }
  /// A lamp that was switched, or was not.
  virtual Result<void> on_switching(const SwitchRecord& /*record*/) { return {}; }
  /// The run is over: what is still held is written.
  virtual Result<void> finish() { return {}; }

  /// Adds its own keys and lines.
  virtual void summarize(Summary& /*summary*/) {}
};

}  // namespace cgsr::sinks
