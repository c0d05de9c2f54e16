#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "platform/time.h"

namespace cgsr {

/// Where time comes from. Whoever needs it is given a Clock; algorithms are not: they get stamps and budgets.
///
/// Threads: every member from any thread. Nothing here allocates; now() never blocks.
class Clock {
 public:
  virtual ~Clock() = default;

  [[nodiscard]] virtual MonoTime now() const = 0;

  /// Returns at `wake_up_at` or as soon after as the scheduler allows; at once when that has passed.
  virtual void sleep_until(MonoTime wake_up_at) = 0;
};

/// CLOCK_MONOTONIC. Sleeps are absolute, so they do not drift and a signal does not shorten them.
class RealClock final : public Clock {
 public:
  [[nodiscard]] MonoTime now() const override;
  void sleep_until(MonoTime wake_up_at) override;
};

/// A time that stands still until its driver moves it. Only hal/sim, hal/replay and the lock-step runner drive one.
///
/// sleep_until waits, in real time, for the driver: the driver's own thread must not sleep on the clock it drives.
class SimulatedClock final : public Clock {
 public:
  explicit SimulatedClock(MonoTime start = MonoTime{}) : now_ns_(start.time_since_epoch().count()) {}

  [[nodiscard]] MonoTime now() const override;
  void sleep_until(MonoTime wake_up_at) override;

  /// Moves time forward and wakes whose time has come. Time never falls: an earlier `time` changes nothing.
  void advance_to(MonoTime time);
  void advance(Duration step) { advance_to(now() + step); }

  /// No further time will come: every sleeper returns, now and for ever. For the end of a recording and for shutdown.
  void end();

 private:
  std::atomic<std::int64_t> now_ns_;
  std::mutex mutex_;
  std::condition_variable moved_;
  bool ended_ = false;
};

/// A cycle of fixed period on any clock. A cycle that takes too long loses whole periods, which are counted; the phase
/// stays and nothing bursts to catch up.
class Periodic {
 public:
  /// \param period > 0. The first wait ends one period from now.
  Periodic(Clock& clock, Duration period);

  /// Sleeps to the start of the next period. \return the time it was due, on the grid of the first one.
  MonoTime wait();

  /// Periods whose start was missed so far.
  [[nodiscard]] std::uint64_t missed() const { return missed_; }

 private:
  Clock& clock_;
  Duration period_;
  MonoTime due_;
  std::uint64_t missed_ = 0;
};

}  // namespace cgsr
