#include "src/boot/time_shifted_can_bus.h"

namespace cgsr::boot {

tl::expected<void, hal::CanSendFailure> TimeShiftedCanBus::send(const hal::CanFrame& frame) {
  hal::CanFrame shifted = frame;
  shifted.stamp -= shift_;
  return bus_->send(shifted);
}

std::size_t TimeShiftedCanBus::receive(MonoTime until, std::span<hal::CanFrame> into) {
  const std::size_t count = bus_->receive(until - shift_, into);
  for (hal::CanFrame& frame : into.first(count)) frame.stamp += shift_;
  return count;
}

}  // namespace cgsr::boot
