#include "src/boot/device_wait.h"

#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "platform/service.h"

namespace cgsr::boot {
namespace {

constexpr Duration kTryEvery = seconds(0.5);
constexpr Duration kNewMessage = seconds(10.0);
constexpr Duration kSameMessage = seconds(60.0);

}  // namespace

DeviceWait::DeviceWait(std::string name, RealClock& clock, StopRequest& stop)
    : name_(std::move(name)), clock_(clock), stop_(stop), since_(clock.now()), rate_(kNewMessage, kSameMessage) {}

bool DeviceWait::again(std::string_view problem) {
  if (rate_.take(problem, clock_.now())) {
    spdlog::warn("waiting for the {} (for {:.0f} s): {}", name_, to_seconds(clock_.now() - since_), problem);
    service::notify_status(fmt::format("waiting for the {}: {}", name_, problem));
  }
  // The service has started: it is the robot that has not. A manager that waited for READY would end it.
  if (!waited_) service::notify_ready();
  waited_ = true;
  service::ping_watchdog();
  return !stop_.wait_until(clock_.now() + kTryEvery);
}

void DeviceWait::found() {
  if (!waited_) return;
  spdlog::info("the {} is there after {:.1f} s", name_, to_seconds(clock_.now() - since_));
  service::notify_status(fmt::format("the {} is there", name_));
}

}  // namespace cgsr::boot
