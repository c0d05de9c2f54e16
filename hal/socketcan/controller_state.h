#pragma once

#include <linux/can.h>

#include <optional>

#include "hal/can_bus.h"

namespace cgsr::hal::socketcan {

/// What an error frame says of the controller (linux/can/error.h).
struct ErrorNews {
  std::optional<CanState> state;  ///< nothing: the frame says nothing about it.
  bool restarted = false;         ///< bus-off was left.
  bool overrun = false;           ///< the controller dropped a frame that it received.
};

/// \param frame  any frame with CAN_ERR_FLAG, whatever its contents.
ErrorNews read_error_frame(const can_frame& frame);

/// \param can_state  enum can_state of linux/can/netlink.h. \return kGone for a controller that is stopped or asleep.
CanState to_state(int can_state);

}  // namespace cgsr::hal::socketcan
