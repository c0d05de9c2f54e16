#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"

namespace cgsr::hal {

/// Named on/off lines of the robot: outputs that switch lamps, inputs such as the arming switch.
///
/// Threads: the switch worker only. Calls may block for milliseconds; that is why they have a thread of their own.
class Switches {
 public:
  virtual ~Switches() = default;

  /// Requests every line. Outputs start off. Starting twice is an error.
  virtual Result<void> start() = 0;

  /// Names of the lines, in the order of the configuration.
  [[nodiscard]] virtual std::vector<std::string> names() const = 0;

  /// Switches an output. \return an error that names the line when there is none of that name, it is an input, or it
  /// did not answer.
  virtual Result<void> set(std::string_view name, bool on) = 0;

  /// Reads a line: of an output, what was last set.
  virtual Result<bool> read(std::string_view name) = 0;

  /// Switches every output off and gives the lines back. Idempotent.
  virtual void stop() = 0;
};

}  // namespace cgsr::hal
