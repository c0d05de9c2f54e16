#pragma once

#include <optional>

#include "pipeline/motion/motion_loop.h"
#include "platform/stop.h"
#include "src/tasks/links.h"

namespace cgsr::tasks {

/// Steps the motion loop with what has arrived since the last cycle. An arming line of which nothing was heard for
/// kMaxArmingReportAge counts as a fault of the safety chain: zero, disarmed, and not armed again before it is heard.
class MotionTask {
 public:
  /// \param latency  a goal arrives that long after its image's stamp: zero live, where it arrives when it does.
  /// \param arm  asks for arming at every cycle until it is granted: the command line's --arm.
  MotionTask(MotionLoop& loop, const StopRequest& stop, Duration latency, bool arm, Links& links)
      : loop_(loop), stop_(stop), latency_(latency), arm_(arm), links_(links) {}

  void step(MonoTime now);

  /// Zero, whatever else is going on. The last command the base gets.
  void end() { loop_.stop(); }

 private:
  std::optional<Goal> newest_goal(MonoTime now);

  MotionLoop& loop_;
  const StopRequest& stop_;
  Duration latency_;
  bool arm_;
  Links& links_;
  std::optional<Goal> on_its_way_;
};

}  // namespace cgsr::tasks
