#include "platform/stop.h"

#include <array>
#include <cassert>
#include <csignal>

namespace cgsr {
namespace {

constexpr std::array kStopSignals{SIGTERM, SIGINT};

// A handler has no other way to reach its object than through globals; lock-free atomics are what it may touch.
std::atomic<StopRequest*> listener{nullptr};
std::atomic<int> last_signal{0};
std::array<struct sigaction, kStopSignals.size()> former;

extern "C" void on_stop_signal(int signal) {
  last_signal.store(signal, std::memory_order_relaxed);
  if (auto* const stop = listener.load(std::memory_order_acquire)) stop->request();
}

}  // namespace

bool StopRequest::wait_until(MonoTime give_up_at) noexcept {
  while (!requested()) {
    if (!wake_up_.wait_until(give_up_at)) return requested();
  }
  return true;
}

StopOnSignals::StopOnSignals(StopRequest& stop) {
  assert(listener.load() == nullptr && "one StopOnSignals at a time");
  last_signal.store(0);
  listener.store(&stop, std::memory_order_release);
  struct sigaction action {};
  action.sa_handler = on_stop_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kStopSignals.size(); ++i) sigaction(kStopSignals[i], &action, &former[i]);
}

StopOnSignals::~StopOnSignals() {
  for (std::size_t i = 0; i < kStopSignals.size(); ++i) sigaction(kStopSignals[i], &former[i], nullptr);
  listener.store(nullptr, std::memory_order_release);
}

int StopOnSignals::received() noexcept {
  return last_signal.load(std::memory_order_relaxed);
}

}  // namespace cgsr
