#pragma once

#include <semaphore.h>

#include <atomic>

#include "platform/time.h"

namespace cgsr {

/// Wakes one thread from any other thread, or from a signal handler. Says only "look again": the news is in a ring, a
/// mailbox or a flag, and the woken thread checks that itself, so a wake-up too many does no harm. A wake-up that comes
/// before the wait is remembered; several that come together are one.
///
/// Memory orders. wake() sets `pending_` with release and wait() clears it with acquire, so what was written before
/// wake() is seen after the wait() that it ended. A wake() that finds `pending_` already set does not post, but its
/// exchange continues the release sequence that the waiter's exchange reads from: what came before it is seen too.
/// Hence the semaphore never counts beyond one.
class WakeUp {
 public:
  WakeUp();
  ~WakeUp();
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  /// Any thread, async-signal-safe, never blocks.
  void wake() noexcept;

  /// The one waiting thread. \param give_up_at on the time line of RealClock; a past one only asks. \return false:
  /// nobody woke us until then.
  bool wait_until(MonoTime give_up_at) noexcept;

  /// The one waiting thread, for as long as it takes.
  void wait() noexcept;

 private:
  void accept() noexcept { pending_.exchange(false, std::memory_order_acq_rel); }

  sem_t semaphore_;
  std::atomic<bool> pending_{false};
  static_assert(std::atomic<bool>::is_always_lock_free);  // the signal handler needs it
};

}  // namespace cgsr
