#pragma once

#include <linux/can.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "hal/can_bus.h"
#include "hal/socketcan/can_socket.h"
#include "hal/socketcan/parameters.h"
#include "platform/wake_up.h"

namespace cgsr::hal::socketcan {

/// Frames with (id & mask) == (IdFilter::id & mask) are received.
struct IdFilter {
  std::uint16_t id = 0;
  std::uint16_t mask = CAN_SFF_MASK;
};

/// A CAN interface of this computer through a raw socket.
///
/// States: bus-off is left by the kernel (restart-ms) or by a restart from here, at most max_restarts in
/// restart_window_s, with a wait that doubles. An interface that is down or gone is kGone and is looked for every
/// reopen_wait_s. Neither makes anything move: the drive above has latched and waits to be re-armed.
///
/// A second commander on this computer is heard like one on the cable: the kernel loops frames of other sockets back.
///
/// Threads: as CanBus, and one of its own for restarts, which may block.
class SocketCanBus final : public CanBus {
 public:
  /// \param filters  at least one. \param socket  not null; make_can_socket() for the kernel's.
  SocketCanBus(SocketCanParameters parameters, const std::vector<IdFilter>& filters, std::unique_ptr<CanSocket> socket);
  ~SocketCanBus() override;
  SocketCanBus(const SocketCanBus&) = delete;
  SocketCanBus& operator=(const SocketCanBus&) = delete;

  Result<void> start() override;
  tl::expected<void, CanSendFailure> send(const CanFrame& frame) override;
  std::size_t receive(MonoTime until, std::span<CanFrame> into) override;
  [[nodiscard]] CanState state() const override { return started_ ? state_ : CanState::kGone; }
  [[nodiscard]] CanCounters counters() const override { return counters_; }
  void stop() override;

  /// \return the errno of the last send or receive that failed other than by a full queue; 0: none since start().
  [[nodiscard]] int last_error() const { return last_error_; }
  /// \return the errno of the last restart; 0: it went through, or none was tried.
  [[nodiscard]] int restart_error() const { return restart_error_.load(std::memory_order_relaxed); }

 private:
  void enter(CanState state);
  void lose(int error);
  void look_after(MonoTime now);
  void restart_if_due(MonoTime now);
  void take_error_frame(const can_frame& frame);
  bool next_frame(CanFrame& into);
  void restart_loop();

  const SocketCanParameters parameters_;
  std::vector<can_filter> filters_;
  std::unique_ptr<CanSocket> socket_;

  bool started_ = false;
  CanState state_ = CanState::kGone;
  CanCounters counters_;
  int last_error_ = 0;
  std::uint32_t socket_lost_ = 0;
  std::optional<CanFrame> early_;            ///< received, but stamped later than it was asked for.
  MonoTime drained_until_{MonoTime::min()};  ///< what is received from now on did not arrive before.
  MonoTime last_stamp_{MonoTime::min()};
  std::optional<MonoTime> reopen_at_;
  std::optional<MonoTime> restart_at_;
  MonoTime window_began_{};
  int restarts_in_window_ = 0;

  // The thread for restarts waits for the wake-up; `quit_` ends it.
  WakeUp restart_wanted_;
  std::atomic<bool> quit_{false};
  std::atomic<int> restart_error_{0};
  std::thread restarter_;
};

}  // namespace cgsr::hal::socketcan
