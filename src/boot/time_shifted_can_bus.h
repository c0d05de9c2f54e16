#pragma once

#include <memory>

#include "hal/can_bus.h"
#include "platform/time.h"

namespace cgsr::boot {

/// A bus whose time starts at 0 (that of the simulated home), used by a program whose clock does not: every stamp is shifted by `origin`.
///
/// Threads and errors: those of the bus behind it. Allocates nothing.
class TimeShiftedCanBus final : public hal::CanBus {
 public:
  /// \param origin  the program's time at which the time of `bus` is 0.
  TimeShiftedCanBus(std::unique_ptr<hal::CanBus> bus, MonoTime origin)
      : bus_(std::move(bus)), shift_(origin.time_since_epoch()) {}

  Result<void> start() override { return bus_->start(); }
  tl::expected<void, hal::CanSendFailure> send(const hal::CanFrame& frame) override;
  std::size_t receive(MonoTime until, std::span<hal::CanFrame> into) override;
  [[nodiscard]] hal::CanState state() const override { return bus_->state(); }
  [[nodiscard]] hal::CanCounters counters() const override { return bus_->counters(); }
  void stop() override { bus_->stop(); }

 private:
  std::unique_ptr<hal::CanBus> bus_;
  Duration shift_;
};

}  // namespace cgsr::boot
