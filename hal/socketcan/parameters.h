#pragma once

#include <string>

#include "platform/parameters.h"

namespace cgsr::hal::socketcan {

/// A CAN interface of this computer.
struct SocketCanParameters {
  std::string interface = "can0";
  int bit_rate = 500'000;
  int max_restarts = 5;
  double restart_window_s = 60.0;
  double restart_wait_s = 0.1;
  double reopen_wait_s = 0.1;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("interface", self.interface, "The name of the CAN interface, as `ip link` shows it.");
    visit.number("bit_rate_bitps", self.bit_rate, {0, 1'000'000}, "bit/s",
                 "The bit rate that the interface must have; 0 accepts any. A virtual interface has none.");
    visit.number("max_restarts", self.max_restarts, {0, 100}, "1",
                 "The number of times within restart_window_s that a controller which is off the bus is restarted; "
                 "after that it stays off until the program starts again.");
    visit.number("restart_window_s", self.restart_window_s, {1.0, 3600.0}, "s",
                 "The time over which restarts are counted.");
    visit.number("restart_wait_s", self.restart_wait_s, {0.02, 10.0}, "s",
                 "The time from bus-off to the first restart; it doubles with every further one in the window.");
    visit.number("reopen_wait_s", self.reopen_wait_s, {0.02, 10.0}, "s",
                 "An interface that is gone or down is looked for this often.");
  }
};

}  // namespace cgsr::hal::socketcan
