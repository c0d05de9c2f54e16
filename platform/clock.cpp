#include "platform/clock.h"

#include <cerrno>
#include <ctime>

namespace cgsr {

MonoTime RealClock::now() const {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return MonoTime{std::chrono::seconds(time.tv_sec) + Duration{time.tv_nsec}};
}

void RealClock::sleep_until(MonoTime wake_up_at) {
  const auto since_boot = wake_up_at.time_since_epoch();
  if (since_boot <= Duration::zero()) return;
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since_boot);
  const timespec until{static_cast<time_t>(whole.count()), static_cast<long>((since_boot - whole).count())};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

MonoTime SimulatedClock::now() const {
  // Acquire pairs with the release in advance_to: who sees a time sees what the driver did before it.
  return MonoTime{Duration{now_ns_.load(std::memory_order_acquire)}};
}

void SimulatedClock::sleep_until(MonoTime wake_up_at) {
  std::unique_lock lock(mutex_);
  moved_.wait(lock, [&] { return ended_ || now() >= wake_up_at; });
}

void SimulatedClock::advance_to(MonoTime time) {
  {
    const std::lock_guard lock(mutex_);
    if (time <= now()) return;
    now_ns_.store(time.time_since_epoch().count(), std::memory_order_release);
  }
  moved_.notify_all();
}

void SimulatedClock::end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  moved_.notify_all();
}

Periodic::Periodic(Clock& clock, Duration period) : clock_(clock), period_(period), due_(clock.now()) {}

MonoTime Periodic::wait() {
  due_ += period_;
  const auto behind = clock_.now() - due_;
  if (behind >= period_) {
    const auto periods = behind / period_;
    missed_ += static_cast<std::uint64_t>(periods);
    due_ += periods * period_;
  }
  clock_.sleep_until(due_);
  return due_;
}

}  // namespace cgsr
