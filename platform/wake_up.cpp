#include "platform/wake_up.h"

#include <algorithm>
#include <cerrno>
#include <ctime>

namespace cgsr {

WakeUp::WakeUp() {
  sem_init(&semaphore_, 0, 0);
}

WakeUp::~WakeUp() {
  sem_destroy(&semaphore_);
}

void WakeUp::wake() noexcept {
  if (pending_.exchange(true, std::memory_order_acq_rel)) return;
  sem_post(&semaphore_);  // cannot fail, so it leaves errno alone: the count is at most one
}

bool WakeUp::wait_until(MonoTime give_up_at) noexcept {
  const auto since_boot = std::max(give_up_at.time_since_epoch(), Duration::zero());
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since_boot);
  const timespec until{static_cast<time_t>(whole.count()), static_cast<long>((since_boot - whole).count())};
  while (sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &until) != 0) {
    if (errno != EINTR) return false;
  }
  accept();
  return true;
}

void WakeUp::wait() noexcept {
  while (sem_wait(&semaphore_) != 0) {
  }
  accept();
}

}  // namespace cgsr
