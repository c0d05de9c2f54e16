#include "platform/stop.h"

#include <unistd.h>

#include <array>
#include <cassert>
#include <csignal>
#include <string_view>

namespace cgsr {
namespace {

constexpr std::array kStopSignals{SIGTERM, SIGINT, SIGHUP};

// A handler has no other way to reach its object than through globals; lock-free atomics are what it may touch.
std::atomic<StopRequest*> listener{nullptr};
std::atomic<int> last_signal{0};
std::array<struct sigaction, kStopSignals.size()> former;
struct sigaction former_pipe;

constexpr int kGoOn = -1;
std::atomic<int> exit_code_at_once{kGoOn};

/// Async-signal-safe.
[[noreturn]] void end_at_once(int exit_code) {
  constexpr std::string_view kLine = "stopped by a signal while loading: nothing was started and nothing was written\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kLine.data(), kLine.size());
  ::_exit(exit_code);
}

extern "C" void on_stop_signal(int signal) {
  last_signal.store(signal, std::memory_order_relaxed);
  if (const int exit_code = exit_code_at_once.load(); exit_code != kGoOn) end_at_once(exit_code);
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
  for (std::size_t i = 0; i < kStopSignals.size(); ++i) {
    sigaction(kStopSignals[i], nullptr, &former[i]);
    const bool by_nohup = kStopSignals[i] == SIGHUP && former[i].sa_handler == SIG_IGN;
    if (!by_nohup) sigaction(kStopSignals[i], &action, nullptr);
  }
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &former_pipe);
}

StopOnSignals::~StopOnSignals() {
  for (std::size_t i = 0; i < kStopSignals.size(); ++i) sigaction(kStopSignals[i], &former[i], nullptr);
  sigaction(SIGPIPE, &former_pipe, nullptr);
  listener.store(nullptr, std::memory_order_release);
}

int StopOnSignals::received() noexcept {
  return last_signal.load(std::memory_order_relaxed);
}

EndAtOnceOnSignals::EndAtOnceOnSignals(int exit_code) {
  exit_code_at_once.store(exit_code);
  if (StopOnSignals::received() != 0) end_at_once(exit_code);
}

EndAtOnceOnSignals::~EndAtOnceOnSignals() {
  exit_code_at_once.store(kGoOn);
}

}  // namespace cgsr
