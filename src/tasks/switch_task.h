#pragma once

#include <array>
#include <optional>
#include <string>

#include "hal/switches.h"
#include "platform/clock.h"
#include "platform/time.h"
#include "src/tasks/links.h"

namespace cgsr::tasks {

/// How often the switch worker looks at the lines.
inline constexpr Duration kSwitchPeriod = seconds(0.050);

/// The lines that the worker knows, by name; empty: there is none.
struct SwitchLines {
  std::string arming;
  std::array<std::string, stages::kLampLines> lamps;  ///< by LampLine.
};

/// Watches the arming line, whose edges are requests to arm and disarm, and switches lamps as vision asks, acknowledging each with the time at which it
/// was done. A line that does not answer disarms; one that answers again is as at boot: its level does not arm, its next rising edge does. So is one that was
/// not read for kMaxArmingReportAge, for a call hung: it disarms once it is read again. Not real-time: a line may block for milliseconds.
class SwitchTask {
 public:
  SwitchTask(hal::Switches& switches, SwitchLines lines, const Clock& clock, Links& links)
      : switches_(switches), lines_(std::move(lines)), clock_(clock), links_(links) {
    if (!lines_.arming.empty()) links_.arming_report.report(clock_.now());
  }

  /// \return what there is to report of the arming line, once each: it does not answer and the robot is disarmed, or it answers again.
  std::optional<std::string> step();

 private:
  std::optional<std::string> watch_arming();
  void switch_lamp(const stages::SwitchRequest& request);

  hal::Switches& switches_;
  SwitchLines lines_;
  const Clock& clock_;
  Links& links_;
  std::optional<bool> level_;  // nothing: not read since boot or since it was silent, its edges alone count
  bool silent_ = false;
};

/// \return an error that names each configured line that does not exist, beside those that do.
Result<void> check_lines(const hal::Switches& switches, const SwitchLines& lines);

}  // namespace cgsr::tasks
