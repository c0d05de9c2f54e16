#pragma once

#include <atomic>

#include "platform/wake_up.h"

namespace cgsr {

/// The one wish that everything ends. Whoever loops asks requested() once per cycle; the service thread waits for it.
class StopRequest {
 public:
  /// Any thread, async-signal-safe. Final: a request is not taken back.
  void request() noexcept {
    requested_.store(true, std::memory_order_release);
    wake_up_.wake();
  }

  /// Any thread. Acquire pairs with the release in request(): what led to it is seen.
  [[nodiscard]] bool requested() const noexcept { return requested_.load(std::memory_order_acquire); }

  /// The service thread only. \return whether it was requested by `give_up_at` (RealClock's time line).
  bool wait_until(MonoTime give_up_at) noexcept;

 private:
  std::atomic<bool> requested_{false};
  WakeUp wake_up_;
};

/// While this lives, SIGTERM, SIGINT and SIGHUP request `stop` instead of ending the process; a SIGHUP that was ignored before (nohup)
/// stays ignored. SIGPIPE is ignored: whoever reads the log may end before the robot does, and a line that nobody reads is no reason to fall
/// silent on the bus. One at a time per process; what the signals did before comes back with the destructor. System calls are restarted, so
/// no other code meets an EINTR from these.
class StopOnSignals {
 public:
  explicit StopOnSignals(StopRequest& stop);
  ~StopOnSignals();
  StopOnSignals(const StopOnSignals&) = delete;
  StopOnSignals& operator=(const StopOnSignals&) = delete;

  /// \return the last signal that came, 0 for none: for the exit line ("stopped by SIGTERM").
  [[nodiscard]] static int received() noexcept;
};

/// While this lives, within a StopOnSignals, a stop signal ends the process at once, with one line on standard error: for work that cannot
/// be interrupted, such as loading a map or a plug-in, before anything moves and before any output has content.
class EndAtOnceOnSignals {
 public:
  /// Ends the process right away when a signal came already.
  explicit EndAtOnceOnSignals(int exit_code);
  ~EndAtOnceOnSignals();
  EndAtOnceOnSignals(const EndAtOnceOnSignals&) = delete;
  EndAtOnceOnSignals& operator=(const EndAtOnceOnSignals&) = delete;
};

}  // namespace cgsr
