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

/// While this lives, SIGTERM and SIGINT request `stop` instead of ending the process. One at a time per process; what
/// the signals did before comes back with the destructor. System calls are restarted, so no other code meets an EINTR
/// from these.
class StopOnSignals {
 public:
  explicit StopOnSignals(StopRequest& stop);
  ~StopOnSignals();
  StopOnSignals(const StopOnSignals&) = delete;
  StopOnSignals& operator=(const StopOnSignals&) = delete;

  /// \return the last signal that came, 0 for none: for the exit line ("stopped by SIGTERM").
  [[nodiscard]] static int received() noexcept;
};

}  // namespace cgsr
