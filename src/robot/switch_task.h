#pragma once

#include <optional>
#include <string>

#include "hal/switches.h"
#include "platform/time.h"
#include "src/robot/links.h"

namespace cgsr::robot {

/// How often the switch worker looks at the lines.
inline constexpr Duration kSwitchPeriod = seconds(0.050);

/// Watches the arming line: its edges are requests to arm and disarm. Not real-time: a line may block for milliseconds.
class SwitchTask {
 public:
  /// \param arming_line  empty: nothing is watched.
  SwitchTask(hal::Switches& switches, std::string arming_line, Links& links)
      : switches_(switches), arming_line_(std::move(arming_line)), links_(links) {}

  /// \return what is wrong with the line, when it does not answer; the robot is disarmed then.
  std::optional<std::string> step();

 private:
  hal::Switches& switches_;
  std::string arming_line_;
  Links& links_;
  std::optional<bool> level_;  // nothing yet: a switch that is on at boot does not arm, its edge does
};

}  // namespace cgsr::robot
