#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "platform/time.h"

namespace cgsr {

/// What the service manager is told (sd_notify). Without a manager (NOTIFY_SOCKET is not set) all of it does nothing.
/// Threads: the service thread only; they write to a socket.
namespace service {
void notify_ready();
void notify_stopping();
void notify_status(std::string_view line);
void ping_watchdog();

/// \return the time between pings that the manager's watchdog needs: half of its own limit; nothing when there is no
///       watchdog.
std::optional<Duration> watchdog_period();
}  // namespace service

/// Who is alive. Each critical thread beats once per cycle; the supervisor pings the watchdog only while none is
/// silent.
///
/// Threads: add at boot; beat from the thread itself, wait-free; silent_at from the supervisor.
class Heartbeats {
 public:
  static constexpr std::size_t kMost = 16;

  /// Registers a thread, counted as heard at `now`.
  /// \param name text that outlives this.
  /// \param longest_silence after which the thread is taken for dead.
  /// \return its number, for beat. At most kMost threads.
  std::size_t add(std::string_view name, Duration longest_silence, MonoTime now);

  void beat(std::size_t number, MonoTime now) noexcept;

  struct Silence {
    std::string_view name;
    Duration lasting;
  };
  /// \return who has been silent for too long and for how long; empty: all is well.
  [[nodiscard]] std::vector<Silence> silent_at(MonoTime now) const;

 private:
  struct Thread {
    std::string_view name;
    Duration longest_silence{};
    // Relaxed throughout: the stamp is the message, it guards nothing else.
    std::atomic<std::int64_t> heard_ns{0};
  };
  std::array<Thread, kMost> threads_;
  std::size_t count_ = 0;
};

/// Pings the watchdog when nobody is silent. \return who was; then no ping went out.
std::vector<Heartbeats::Silence> supervise(const Heartbeats& heartbeats, MonoTime now);

}  // namespace cgsr
