#pragma once

#include <string>
#include <string_view>

#include "platform/clock.h"
#include "platform/error.h"
#include "platform/message_rate.h"
#include "platform/stop.h"

namespace cgsr::boot {

/// Waits for a device of this computer that is not there yet, says so at a bounded rate (log, and the line that the
/// service manager shows), and pings the manager's watchdog meanwhile: no thread that it watches over runs yet.
///
/// Threads: the service thread.
class DeviceWait {
 public:
  /// \param name  "camera". \param clock, stop  outlive this.
  DeviceWait(std::string name, RealClock& clock, StopRequest& stop);

  /// Waits before the next try. \param problem  why the last one failed. \return false when a stop was requested: no
  /// further try.
  bool again(std::string_view problem);

  /// Says that the device is there, if anything was said before.
  void found();

 private:
  std::string name_;
  RealClock& clock_;
  StopRequest& stop_;
  MonoTime since_;
  MessageRate rate_;
  bool waited_ = false;
};

/// Tries until `open` succeeds or a stop is requested. \return what `open` returned last.
template <class Open>
auto open_when_there(std::string name, RealClock& clock, StopRequest& stop, Open open) {
  DeviceWait wait(std::move(name), clock, stop);
  auto opened = open();
  while (!opened && wait.again(opened.error().message)) opened = open();
  if (opened) wait.found();
  return opened;
}

}  // namespace cgsr::boot
