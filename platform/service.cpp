#include "platform/service.h"

#include <systemd/sd-daemon.h>

#include <stdexcept>
#include <string>

namespace cgsr {
namespace service {

void notify_ready() {
  sd_notify(0, "READY=1");
}

void notify_stopping() {
  sd_notify(0, "STOPPING=1");
}

void notify_status(std::string_view line) {
  sd_notify(0, ("STATUS=" + std::string(line)).c_str());
}

void ping_watchdog() {
  sd_notify(0, "WATCHDOG=1");
}

std::optional<Duration> watchdog_period() {
  std::uint64_t limit_us = 0;
  if (sd_watchdog_enabled(0, &limit_us) <= 0) return std::nullopt;
  return std::chrono::microseconds(limit_us / 2);
}

}  // namespace service

std::size_t Heartbeats::add(std::string_view name, Duration longest_silence, MonoTime now) {
  auto& thread = threads_.at(count_);
  thread.name = name;
  thread.longest_silence = longest_silence;
  beat(count_, now);
  return count_++;
}

void Heartbeats::beat(std::size_t number, MonoTime now) noexcept {
  threads_[number].heard_ns.store(now.time_since_epoch().count(), std::memory_order_relaxed);
}

std::vector<Heartbeats::Silence> Heartbeats::silent_at(MonoTime now) const {
  std::vector<Silence> silent;
  for (std::size_t i = 0; i < count_; ++i) {
    const auto& thread = threads_[i];
    const auto lasting = now - MonoTime{Duration{thread.heard_ns.load(std::memory_order_relaxed)}};
    if (lasting > thread.longest_silence) silent.push_back({thread.name, lasting});
  }
  return silent;
}

std::vector<Heartbeats::Silence> supervise(const Heartbeats& heartbeats, MonoTime now) {
  auto silent = heartbeats.silent_at(now);
  if (silent.empty()) service::ping_watchdog();
  return silent;
}

}  // namespace cgsr
